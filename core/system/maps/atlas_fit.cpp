// What a saved atlas was made with, and whether a run can go on in it.
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

#include "core/base/check.h"
#include "core/system/maps/atlas_file.h"

namespace vsgraphs {

namespace {

std::string text_of(bool value) { return value ? "true" : "false"; }
template <typename Number>
std::string text_of(Number value) {
  std::array<char, 40> digits{};
  return {digits.data(), std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr};
}
// In quotes, as YAML's double-quoted texts.
std::string text_of(const std::string& value) {
  std::string quoted = "\"";
  for (const char c : value) {
    if (c == '"' || c == '\\') quoted += '\\';
    quoted += c;
  }
  return quoted + '"';
}

std::string size_of(const Camera& camera) {
  return std::to_string(camera.width) + "x" + std::to_string(camera.height);
}

std::string lens_of(const Camera& camera) {
  const auto px = [](double value) { return std::to_string(std::lround(value)); };
  return "fx " + px(camera.fx) + ", fy " + px(camera.fy) + ", cx " + px(camera.cx) + ", cy " + px(camera.cy);
}

// Another calibration of one camera differs by less than this share of its focal length; another camera by more.
bool same_lens(const Camera& a, const Camera& b) {
  const double tolerance_px = 0.02 * a.fx;
  return std::abs(a.fx - b.fx) <= tolerance_px && std::abs(a.fy - b.fy) <= tolerance_px &&
         std::abs(a.cx - b.cx) <= tolerance_px && std::abs(a.cy - b.cy) <= tolerance_px;
}

int rank(const std::string& mode) { return mode == "full" ? 2 : mode == "bc" ? 1 : 0; }

}  // namespace

std::string configuration_text(const Config& config) {
  std::string lines;
  for (const OptionDescription& option : config.describe_all()) {
    lines += option.key + ": ";
    lines += std::visit([](const auto& value) { return text_of(value); }, option.value);
    lines += '\n';
  }
  return lines;
}

std::string configured(const std::string& configuration, const std::string& key) {
  const std::string start = key + ": ";
  for (std::size_t at = 0; at < configuration.size();) {
    const std::size_t end = std::min(configuration.find('\n', at), configuration.size());
    if (configuration.compare(at, start.size(), start) == 0) {
      std::string value = configuration.substr(at + start.size(), end - at - start.size());
      if (value.size() >= 2 && value.front() == '"' && value.back() == '"')
        value = value.substr(1, value.size() - 2);
      return value;
    }
    at = end + 1;
  }
  return {};
}

void require_fit(const std::string& name, const SavedAtlas& atlas, const Config& config,
                 const Camera& camera) {
  const Camera& made = atlas.camera;
  require_input(made.width == camera.width && made.height == camera.height,
                name + ": was mapped with images of " + size_of(made) + " pixels, and this camera's have " +
                    size_of(camera) + "; use the camera it was mapped with, or map anew");
  require_input(same_lens(made, camera), name + ": was mapped with a camera of " + lens_of(made) +
                                             " px, and this one has " + lens_of(camera) +
                                             "; use the camera it was mapped with, or map anew");
  const std::string now = configuration_text(config);
  for (const char* key : {"orb.levels", "orb.scale_factor"}) {
    const std::string then = configured(atlas.configuration, key);
    require_input(then == configured(now, key), name + ": was mapped with " + key + " = " + then +
                                                    ", and this run has " + configured(now, key) +
                                                    "; set it to the same");
  }
  const std::string mode = configured(atlas.configuration, "system.mode");
  require_input(config.system.localise_only || rank(config.system.mode) >= rank(mode),
                name + ": was mapped with --mode " + mode + ", and --mode " + config.system.mode +
                    " would leave what that found untended; run with --mode " + mode + " or --localise-only");
}

}  // namespace vsgraphs
