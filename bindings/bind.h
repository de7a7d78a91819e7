// One function per folder of the core; module.cpp calls them in order.
#pragma once

#include <nanobind/nanobind.h>

namespace vsgraphs {

class Map;

void bind_camera(nanobind::module_& m);
void bind_config(nanobind::module_& m);
// The map's structure as Python values; see Snapshot.scene_graph.
nanobind::dict scene_graph_of(const Map& map);
void bind_slam(nanobind::module_& m);
void bind_atlas(nanobind::module_& m);
void bind_simulate(nanobind::module_& m);

}  // namespace vsgraphs
