// Which kinds of relations take part in adjustments. All of them by default; switching one off shows what it is worth.
#pragma once

#include "core/base/options.h"

namespace vsgraphs {

struct FactorSwitches {
  bool tracked_link = true;
  bool plane_observation = true;
  bool plane_prior = true;
  bool wall_upright = true;
  bool plane_parallel = true;
  bool plane_perpendicular = true;
  bool room_centroid = true;
  bool floor_centroid = true;
  bool marker_pose = true;
};

template <typename Visitor>
void describe(FactorSwitches& o, Visitor& field) {
  field("tracked_link", o.tracked_link,
        "a keyframe with few landmarks is tied to its reference by what tracking measured");
  field("plane_observation", o.plane_observation, "keyframes of the window are tied to the planes they see");
  field("plane_prior", o.plane_prior, "planes are held by what keyframes outside of the window saw of them");
  field("wall_upright", o.wall_upright, "walls stand upright on their ground");
  field("plane_parallel", o.plane_parallel, "walls of a room that nearly are parallel are held to it");
  field("plane_perpendicular", o.plane_perpendicular,
        "walls of a room that nearly are perpendicular are held to it");
  field("room_centroid", o.room_centroid, "a room's node is the mean of its walls'");
  field("floor_centroid", o.floor_centroid,
        "a floor's node is the mean of its rooms'; none without room_centroid");
  field("marker_pose", o.marker_pose, "keyframes are tied to the markers they see");
}

}  // namespace vsgraphs
