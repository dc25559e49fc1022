#include "fluoroscopy/motion/displacement_lattice.h"

#include <algorithm>

namespace endovascular_sim::fluoroscopy
{

DisplacementLattice::DisplacementLattice(const Eigen::AlignedBox3d& box, double spacing)
  : origin_(box.min()),
    inverse_spacing_(1.0 / spacing),
    size_(((box.sizes() / spacing).array().ceil().cast<int>() + 2).matrix())
{
  nodes_.reserve(static_cast<std::size_t>(size_.prod()));
  for (int k = 0; k < size_.z(); ++k)
    for (int j = 0; j < size_.y(); ++j)
      for (int i = 0; i < size_.x(); ++i)
        nodes_.emplace_back(origin_ + spacing * Eigen::Vector3d(i, j, k));
  displacement_.assign(nodes_.size(), Eigen::Vector4f::Zero());
}

void DisplacementLattice::fill(const BodyMotion& motion, const Eigen::Matrix3d& turn)
{
  motion.pullBack(nodes_, rest_);
  for (std::size_t k = 0; k < nodes_.size(); ++k)
    displacement_[k].head<3>() = (turn * (rest_[k] - nodes_[k])).cast<float>();
}

Eigen::Vector3f DisplacementLattice::at(const Eigen::Vector3d& point) const
{
  const Eigen::Vector3d place = (point - origin_) * inverse_spacing_;
  if (!((place.array() >= 0.0).all() && place.x() < size_.x() - 1 && place.y() < size_.y() - 1 &&
        place.z() < size_.z() - 1))
    return Eigen::Vector3f::Zero();
  const Eigen::Vector3i cell = place.cast<int>();
  const Eigen::Vector3f f = (place - cell.cast<double>()).cast<float>();
  const std::ptrdiff_t row = size_.x(), layer = row * size_.y();
  const Eigen::Vector4f* node = displacement_.data() + cell.z() * layer + cell.y() * row + cell.x();
  const auto along = [&](std::ptrdiff_t offset) -> Eigen::Vector4f
  { return node[offset] + f.x() * (node[offset + 1] - node[offset]); };
  const Eigen::Vector4f low = along(0) + f.y() * (along(row) - along(0));
  const Eigen::Vector4f high = along(layer) + f.y() * (along(layer + row) - along(layer));
  return (low + f.z() * (high - low)).head<3>();
}

}  // namespace endovascular_sim::fluoroscopy
