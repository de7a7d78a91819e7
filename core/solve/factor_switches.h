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
        "use the factor that ties a keyframe with few landmarks to its reference as tracking measured it");
  field("plane_observation", o.plane_observation,
        "use the factors that tie the window's keyframes to the planes they see");
  field("plane_prior", o.plane_prior,
        "use the factors that hold planes where keyframes outside the window saw them");
  field("wall_upright", o.wall_upright, "use the factors that hold walls perpendicular to their ground");
  field("plane_parallel", o.plane_parallel,
        "use the factors that hold nearly parallel walls of a room parallel");
  field("plane_perpendicular", o.plane_perpendicular,
        "use the factors that hold nearly perpendicular walls of a room perpendicular");
  field("room_centroid", o.room_centroid, "use the factors that tie a room's node to the mean of its walls");
  field("floor_centroid", o.floor_centroid,
        "use the factors that tie a floor's node to the mean of its rooms; needs room_centroid");
  field("marker_pose", o.marker_pose, "use the factors that tie keyframes to the markers they see");
}

}  // namespace vsgraphs
