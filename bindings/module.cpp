#include <nanobind/nanobind.h>

#include "bindings/bind.h"
#include "core/base/check.h"

NB_MODULE(_core, m) {
  m.doc() = "The compiled core of vsgraphs. Use it through the package `vsgraphs`.";
  nanobind::exception<vsgraphs::InputError>(m, "InputError", PyExc_ValueError);
  vsgraphs::bind_camera(m);
  vsgraphs::bind_config(m);
  vsgraphs::bind_slam(m);
  vsgraphs::bind_simulate(m);
}
