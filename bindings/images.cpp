#include "bindings/images.h"

#include <nanobind/ndarray.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <string>

#include "core/base/check.h"

namespace nb = nanobind;

namespace vsgraphs {

namespace {

std::string type_of(const nb::dlpack::dtype& type) {
  using Code = nb::dlpack::dtype_code;
  if (type.code == static_cast<std::uint8_t>(Code::Bool)) return "bool";
  const bool known = type.code <= static_cast<std::uint8_t>(Code::Float);
  const char* const names[] = {"int", "uint", "float"};
  const std::string name = known                                                   ? names[type.code]
                           : type.code == static_cast<std::uint8_t>(Code::Complex) ? "complex"
                                                                                   : "another type of ";
  return name + std::to_string(type.bits);
}

std::string told(const AnyImage& image) {
  std::string text = type_of(image.dtype()) + " of shape (";
  for (std::size_t i = 0; i < image.ndim(); ++i) text += (i ? ", " : "") + std::to_string(image.shape(i));
  return text + (image.ndim() == 1 ? ",)" : ")");
}

std::string text_of(const nb::object& value) { return nb::str(nb::handle(value)).c_str(); }

[[noreturn]] void refuse(const std::string& name, const char* expected, const std::string& given,
                         const std::string& cure = "") {
  throw InputError(name + ": must be " + expected + ", not " + given + (cure.empty() ? "" : "; " + cure));
}

// `expected` completes "must be ...".
AnyImage image_of(nb::handle given, const std::string& name, const char* expected) {
  AnyImage image;
  if (!given.is_none() && nb::try_cast(given, image)) return image;
  PyErr_Clear();
  const std::string device = nb::hasattr(given, "device") ? text_of(given.attr("device")) : "cpu";
  if (device != "cpu") refuse(name, expected, "an array on " + device, "move it to the memory first");
  if (nb::hasattr(given, "dtype"))  // an array that no other library reads: bytes swapped, objects, texts
    refuse(name, expected, text_of(given.attr("dtype")));
  const std::string type = text_of(given.type().attr("__name__"));
  throw nb::type_error((name + ": must be a numpy array, not " + type).c_str());
}

// Rows must be dense; rows themselves may be apart (a view of a wider array).
template <typename T>
ImageView<T> view_of(const AnyImage& image, const std::string& name, std::int64_t channels) {
  require_input(image.size() > 0, name + ": the image is empty, " + told(image));
  const bool dense = image.stride(1) == channels && (image.ndim() == 2 || image.stride(2) == 1);
  require_input(dense && image.stride(0) % channels == 0 && image.stride(0) >= 0,
                name + ": the image's rows are not contiguous; pass numpy.ascontiguousarray(image)");
  constexpr std::size_t longest = 1 << 16;  // far beyond every camera
  require_input(image.shape(0) < longest && image.shape(1) < longest,
                name + ": larger than any image, " + told(image));
  return {static_cast<const T*>(image.data()), static_cast<int>(image.shape(1)),
          static_cast<int>(image.shape(0)), image.stride(0) / channels};
}

constexpr const char* colour_expected = "uint8 of shape (height, width, 3) or (height, width)";
constexpr const char* depth_expected =
    "uint16 (raw units, see Camera.depth_scale) or float32 (metres) of shape (height, width)";

bool is(const AnyImage& image, auto type) { return image.dtype() == nb::dtype<decltype(type)>(); }

bool looks_like_depth(const AnyImage& image) {
  return image.ndim() == 2 && (is(image, std::uint16_t{}) || is(image, float{}));
}

std::string cure_of_colour(const AnyImage& rgb, const AnyImage& depth) {
  if (looks_like_depth(rgb) && is(depth, std::uint8_t{})) return "are rgb and depth in each other's place?";
  if (rgb.ndim() == 3 && rgb.shape(2) == 4) return "leave out the fourth channel: rgb[:, :, :3].copy()";
  if (rgb.ndim() == 3 && rgb.shape(0) == 3 && rgb.shape(2) != 3)
    return "the channels come last: numpy.ascontiguousarray(numpy.moveaxis(rgb, 0, 2))";
  if (is(rgb, float{}) || is(rgb, double{})) return "from 0 to 1: (255 * rgb).astype(numpy.uint8)";
  return "";
}

std::string cure_of_depth(const AnyImage& depth) {
  if (depth.ndim() == 3 && depth.shape(2) == 1) return "take depth[:, :, 0]";
  if (is(depth, double{})) return "metres: depth.astype(numpy.float32)";
  if (is(depth, std::int32_t{}) || is(depth, std::int64_t{}) || is(depth, std::uint32_t{}))
    return "raw units below 65536: depth.astype(numpy.uint16)";
  return "";
}

template <typename T>
AnyImage view_labels(nb::handle given, const char* what, const char* expected, ImageView<T>& view) {
  const std::string name = std::string("segmentation: ") + what;
  AnyImage image = image_of(given, name, expected);
  if (image.ndim() != 2 || !is(image, T{})) refuse(name, expected, told(image));
  view = view_of<T>(image, name, 1);
  return image;
}

std::vector<std::string> names_of(nb::handle given) {
  std::vector<std::string> names;
  if (nb::try_cast(given, names)) return names;
  PyErr_Clear();
  refuse("segmentation: class_names", "a list of texts", text_of(given.type().attr("__name__")),
         "one name per class, class k is the k-th");
}

}  // namespace

GivenFrame frame_of(nb::handle rgb_given, nb::handle depth_given, double timestamp) {
  GivenFrame given{
      image_of(rgb_given, "rgb", colour_expected), image_of(depth_given, "depth", depth_expected), {}};
  const AnyImage &rgb = given.rgb, &depth = given.depth;
  const bool grey = rgb.ndim() == 2;
  if (!is(rgb, std::uint8_t{}) || !(grey || (rgb.ndim() == 3 && rgb.shape(2) == 3)))
    refuse("rgb", colour_expected, told(rgb), cure_of_colour(rgb, depth));
  if (depth.ndim() != 2 || !(is(depth, std::uint16_t{}) || is(depth, float{})))
    refuse("depth", depth_expected, told(depth), cure_of_depth(depth));
  given.frame.timestamp_s = timestamp;
  if (grey) {
    given.frame.grey = view_of<std::uint8_t>(rgb, "rgb", 1);
  } else {
    given.frame.colour = view_of<Rgb>(rgb, "rgb", 3);
  }
  if (is(depth, float{})) {
    given.frame.depth.metres = view_of<float>(depth, "depth", 1);
  } else {
    given.frame.depth.raw = view_of<std::uint16_t>(depth, "depth", 1);
  }
  return given;
}

GivenSegmentation segmentation_of(nb::handle roles, nb::handle confidence, nb::handle instances,
                                  nb::handle classes, nb::handle class_names) {
  GivenSegmentation given;
  Segmentation& into = given.images;
  given.roles = view_labels(roles, "roles", "uint8 of shape (height, width)", into.roles);
  if (!confidence.is_none())
    given.confidence =
        view_labels(confidence, "confidence", "float32 of shape (height, width)", into.confidence);
  if (!instances.is_none())
    given.instances = view_labels(instances, "instances", "uint16 of shape (height, width)", into.instances);
  if (!classes.is_none())
    given.classes = view_labels(classes, "classes", "uint16 of shape (height, width)", into.classes);
  if (!class_names.is_none()) given.class_names = names_of(class_names);
  return given;
}

}  // namespace vsgraphs
