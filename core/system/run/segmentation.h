// A segmenter's answer for one image, and what of it the map keeps.
#pragma once

#include <mutex>
#include <span>
#include <string>

#include "core/base/image.h"
#include "core/geometry/camera.h"
#include "core/map/label_grid.h"

namespace vsgraphs {

// Borrowed for the length of one call.
struct Segmentation {
  ImageView<std::uint8_t> roles;  // values of SurfaceRole
  ImageView<float> confidence;
  ImageView<std::uint16_t> instances;
  ImageView<std::uint16_t> classes{};  // 0: none; k: the k-th of class_names
  std::span<const std::string> class_names{};
};

// The label nearest to each sample of the camera's depth grids. Throws InputError for sizes that differ, values that are no roles, no
// confidences or no classes, names that are none or there twice, and two names of one number.
LabelGrid sample_labels(const Segmentation& segmentation, const Camera& camera);

// The classes that a run has heard of: in one run, or in the maps that it may join, a number has one name. Any thread.
class ClassRegister {
 public:
  // Throws InputError, and takes none of them, where one has another name here.
  void take(const ClassNames& names);

 private:
  std::mutex mutex_;
  ClassNames known_;
};

}  // namespace vsgraphs
