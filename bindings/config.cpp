#include "core/system/config/config.h"

#include <nanobind/stl/string.h>
#include <nanobind/stl/variant.h>
#include <nanobind/stl/vector.h>

#include "bindings/bind.h"

namespace nb = nanobind;
using namespace nb::literals;

namespace vsgraphs {

namespace {

nb::dict to_dict(const OptionDescription& option) {
  nb::dict d;
  d["key"] = option.key;
  d["value"] = option.value;
  d["default"] = option.default_value;
  const bool number =
      std::holds_alternative<std::int64_t>(option.value) || std::holds_alternative<double>(option.value);
  const char* const types[] = {"bool", "int", "float", "str"};
  d["type"] = types[option.value.index()];
  d["minimum"] = number ? nb::cast(option.minimum) : nb::none();
  d["maximum"] = number ? nb::cast(option.maximum) : nb::none();
  d["allowed"] = option.allowed;
  d["meaning"] = option.meaning;
  return d;
}

}  // namespace

void bind_config(nb::module_& m) {
  nb::class_<Config>(m, "Config", "All options of a run, by dotted keys such as \"tracker.coast_s\".")
      .def(nb::init<>())
      .def("set", &Config::set, "key"_a, "value"_a,
           "Sets one option. Raises InputError for an unknown key (naming the nearest), a wrong type or a "
           "value "
           "out of range (naming the range).")
      .def("get", &Config::get, "key"_a, "The option's value. Raises InputError for an unknown key.")
      .def("keys",
           [](const Config& c) {
             std::vector<std::string> keys;
             for (const OptionDescription& option : c.describe_all()) keys.push_back(option.key);
             return keys;
           })
      .def(
          "describe",
          [](const Config& c) {
            nb::list list;
            for (const OptionDescription& option : c.describe_all()) list.append(to_dict(option));
            return list;
          },
          nb::sig("def describe(self) -> list[dict[str, typing.Any]]"),
          "A list of dicts with key, type, value, default, minimum, maximum, allowed and meaning.");
}

}  // namespace vsgraphs
