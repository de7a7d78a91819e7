// Images from Python: numpy arrays as views, and what is wrong with those that are none.
#pragma once

#include <nanobind/ndarray.h>

#include <string>
#include <vector>

#include "core/matching/messages.h"
#include "core/system/run/segmentation.h"

namespace vsgraphs {

using AnyImage = nanobind::ndarray<nanobind::ro, nanobind::device::cpu>;

// Views, and what keeps their pixels alive.
struct GivenFrame {
  AnyImage rgb, depth;
  RgbdFrame frame;
};
struct GivenSegmentation {
  AnyImage roles, confidence, instances, classes;
  std::vector<std::string> class_names;

  Segmentation segmentation() const {
    Segmentation all = images;
    all.class_names = class_names;
    return all;
  }
  Segmentation images;  // without names
};

// rgb: uint8, (h, w, 3) or (h, w); depth: (h, w), uint16 raw or float32 metres. Throws InputError that names type and shape of
// what was given, TypeError for what is no array.
GivenFrame frame_of(nanobind::handle rgb, nanobind::handle depth, double timestamp);

// roles uint8, confidence float32, instances and classes uint16 or None, all (h, w); class_names a list of str or None; likewise.
GivenSegmentation segmentation_of(nanobind::handle roles, nanobind::handle confidence,
                                  nanobind::handle instances, nanobind::handle classes,
                                  nanobind::handle class_names);

}  // namespace vsgraphs
