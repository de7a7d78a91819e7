#include <nanobind/nanobind.h>

#include <string>
#include <system_error>

#include "bindings/bind.h"
#include "build_info.h"
#include "core/base/check.h"
#include "core/system/config/version.h"

NB_MODULE(_core, m) {
  m.doc() = "The compiled core of vsgraphs. Use it through the package `vsgraphs`.";
  // The package's own class, found when it is needed: whoever catches vsgraphs.InputError catches the core's too.
  nanobind::register_exception_translator([](const std::exception_ptr& error, void*) {
    try {
      std::rethrow_exception(error);
    } catch (const vsgraphs::InputError& e) {
      PyErr_SetString(nanobind::module_::import_("vsgraphs.errors").attr("InputError").ptr(), e.what());
    } catch (const vsgraphs::RunError& e) {
      PyErr_SetString(nanobind::module_::import_("vsgraphs.errors").attr("RunError").ptr(), e.what());
    } catch (const std::system_error& e) {
      const bool no_room = e.code() == std::errc::resource_unavailable_try_again;  // for another thread
      PyErr_SetString(no_room ? PyExc_MemoryError : PyExc_OSError,
                      (std::string("the system refused: ") + e.what()).c_str());
    }
  });
  m.def(
      "build_info",
      [] {
        nanobind::dict info;
        info["commit"] = VSGRAPHS_COMMIT;
        info["compiler"] = VSGRAPHS_COMPILER;
        info["core"] = vsgraphs::version();
        info["processor_level"] = vsgraphs::processor_level();
        return info;
      },
      nanobind::sig("def build_info() -> dict[str, str]"),
      "What the module was built from and for: commit, compiler, the core's version, the processor's level.");
  vsgraphs::bind_camera(m);
  vsgraphs::bind_config(m);
  vsgraphs::bind_slam(m);
  vsgraphs::bind_atlas(m);
  vsgraphs::bind_simulate(m);
}
