"""Writes a volume of synthetic_ct as a DICOM series by pydicom: VOLUME FOLDER."""
import os
import struct
import sys

import pydicom
from pydicom.dataset import FileDataset, FileMetaDataset
from pydicom.uid import CTImageStorage, ExplicitVRLittleEndian


def write_slice(path, number, size, spacing, place, axes, pixels):
    meta = FileMetaDataset()
    meta.MediaStorageSOPClassUID = CTImageStorage
    meta.MediaStorageSOPInstanceUID = "1.2.826.0.1.8.%d" % number
    meta.TransferSyntaxUID = ExplicitVRLittleEndian
    image = FileDataset(path, {}, file_meta=meta, preamble=bytes(128))
    image.is_little_endian, image.is_implicit_VR = True, False
    image.SOPClassUID, image.SOPInstanceUID = CTImageStorage, meta.MediaStorageSOPInstanceUID
    image.PatientName, image.PatientID, image.PatientBirthDate = "Doe^Jane", "ID4711", "19620314"
    image.Modality = "CT"
    image.StudyInstanceUID, image.SeriesInstanceUID = "1.2.826.0.1", "1.2.826.0.1.8"
    image.InstanceNumber = number
    image.ImagePositionPatient = ["%.9g" % x for x in place]
    image.ImageOrientationPatient = ["%.12g" % x for axis in axes[:2] for x in axis]
    image.PixelSpacing = ["%.9g" % spacing[1], "%.9g" % spacing[0]]
    image.SliceThickness = "%.9g" % spacing[2]
    image.Columns, image.Rows = size[0], size[1]
    image.SamplesPerPixel, image.PhotometricInterpretation = 1, "MONOCHROME2"
    image.BitsAllocated, image.BitsStored, image.HighBit, image.PixelRepresentation = 16, 16, 15, 0
    image.RescaleSlope, image.RescaleIntercept = "1", "-32768"
    image.PixelData = struct.pack("<%dH" % len(pixels), *(n + 32768 for n in pixels))
    image.save_as(path, write_like_original=False)


def main(volume, folder):
    with open(volume, "rb") as file:
        data = file.read()
    size = struct.unpack_from("<3i", data, 8)
    numbers = [1e3 * x for x in struct.unpack_from("<6d", data, 24)]
    spacing, origin = numbers[:3], numbers[3:]
    axes = [struct.unpack_from("<3d", data, 72 + 24 * axis) for axis in range(3)]
    count = size[0] * size[1]
    os.makedirs(folder)
    for k in range(size[2]):
        place = [origin[row] + k * spacing[2] * axes[2][row] for row in range(3)]
        pixels = struct.unpack_from("<%dh" % count, data, 160 + 2 * count * k)
        # The names are not in the order of the slices.
        write_slice(os.path.join(folder, "%03d" % ((7 * k) % 1009)), k + 1, size, spacing, place, axes, pixels)


assert pydicom.__version__ >= "2"
main(*sys.argv[1:])
