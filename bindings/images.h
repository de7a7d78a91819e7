// Images from Python: numpy arrays as views, and what is wrong with those that are none.
#pragma once

#include <nanobind/ndarray.h>

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
  AnyImage roles, confidence, instances;
  Segmentation segmentation;
};

// rgb: uint8, (h, w, 3) or (h, w); depth: (h, w), uint16 raw or float32 metres. Throws InputError that names type and shape of
// what was given, TypeError for what is no array.
GivenFrame frame_of(nanobind::handle rgb, nanobind::handle depth, double timestamp);

// roles uint8, confidence float32, instances uint16 or None, all (h, w); likewise.
GivenSegmentation segmentation_of(nanobind::handle roles, nanobind::handle confidence,
                                  nanobind::handle instances);

}  // namespace vsgraphs
