// The plan's structs as Python classes: default values, then one assignment per key of the plan file.
#pragma once

#include <nanobind/nanobind.h>

namespace vsgraphs {

void bind_plan(nanobind::module_& m);

}  // namespace vsgraphs
