#pragma once

#include <string>

#include "segmentation/lumen/scan.h"

namespace endovascular_sim::segmentation
{

/** HTML page on which an operator clicks vessels: three planes, a projection of maximal values, and the clicks as YAML
 * for readClicks(). The page is one file without references; it works from a local disk, in any browser. It holds the
 * image with 8 bits per voxel, averaged over voxels until at most 16 million remain, and no name, number or date of the
 * patient.
 */
std::string ctPage(const Scan& scan);

/** Base64 encoding (RFC 4648). */
std::string base64(const std::string& bytes);

}  // namespace endovascular_sim::segmentation
