// The Python module vsgraphs._processor: what this machine's processor can run, asked before anything that an old one
// could not execute is loaded. Compiled for every x86-64 and free of all else for that reason.
#define PY_SSIZE_T_CLEAN
#include <Python.h>

namespace {

PyObject* levels(PyObject*, PyObject*) {
  __builtin_cpu_init();  // asks the operating system too: AVX needs its help
  const struct {
    const char* name;
    bool runs;
  } all[] = {{"x86-64-v2", __builtin_cpu_supports("x86-64-v2") != 0},
             {"x86-64-v3", __builtin_cpu_supports("x86-64-v3") != 0},
             {"x86-64-v4", __builtin_cpu_supports("x86-64-v4") != 0}};
  PyObject* found = PyList_New(0);
  for (const auto& level : all) {
    if (found == nullptr || !level.runs) continue;
    PyObject* name = PyUnicode_FromString(level.name);
    if (name == nullptr || PyList_Append(found, name) != 0) Py_CLEAR(found);
    Py_XDECREF(name);
  }
  return found;
}

PyMethodDef functions[] = {{"levels", levels, METH_NOARGS,
                            "The x86-64 levels above the first that processor and system run, lowest first."},
                           {nullptr, nullptr, 0, nullptr}};
PyModuleDef definition = {PyModuleDef_HEAD_INIT,
                          "_processor",
                          "What this machine's processor can run.",
                          0,
                          functions,
                          nullptr,
                          nullptr,
                          nullptr,
                          nullptr};

}  // namespace

PyMODINIT_FUNC PyInit__processor() { return PyModule_Create(&definition); }
