#pragma once

#include <map>
#include <string>

namespace endovascular_sim::segmentation
{

/** Names of the labels of a label map. */
using LabelNames = std::map<long, std::string>;

/** Reads a table of labels. The ending of the file names its form:
 *
 *  - .yaml, .yml, .json: a map from numbers to names or from names to numbers, below any keys (the class maps of
 *    TotalSegmentator, `labels` of nnU-Net), or a list of maps with the number (`id`, `label`, `value` or `index`) and
 *    the `name`;
 *  - .csv, .tsv: columns of the number and the name, with or without a line of titles;
 *  - .ctbl, .txt: colour table of 3D Slicer (number, name, colours) or of ITK-SNAP (number, colours, "name").
 *
 *  Names are reduced to letters, digits, `_`, `-` and `.`.
 *  @throws InputError for another form, a table without labels, and two names of one label */
LabelNames readLabelNames(const std::string& file);

}  // namespace endovascular_sim::segmentation
