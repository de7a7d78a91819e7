#include "core/map/levelling.h"

#include <Eigen/Geometry>

namespace vsgraphs {

Se3 levelling(const Map& map) {
  const FoundStructure& last = map.structure();
  const Eigen::Matrix3d before = last.sought ? last.level_from_world.rotation() : Eigen::Matrix3d::Identity();
  const Eigen::Vector3d up = before * *map.up_in_world();
  const Eigen::Matrix3d turn =
      Eigen::Quaterniond::FromTwoVectors(up, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  return Se3(turn * before, Eigen::Vector3d::Zero()).normalized();
}

}  // namespace vsgraphs
