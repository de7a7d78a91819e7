#include "core/system/run/segmentation.h"

#include <algorithm>
#include <string>

#include "core/base/check.h"
#include "core/vision/depth_sampling.h"

namespace vsgraphs {
namespace {

template <typename Pixel>
void require_same_size(const ImageView<Pixel>& image, const Segmentation& s, const char* name) {
  require_input(image.empty() || (image.width == s.roles.width && image.height == s.roles.height),
                std::string("segmentation: ") + name + " has another size than roles");
}

}  // namespace

LabelGrid sample_labels(const Segmentation& s, const Camera& camera) {
  require_input(!s.roles.empty(), "segmentation: roles is empty");
  require_same_size(s.confidence, s, "confidence");
  require_same_size(s.instances, s, "instances");
  LabelGrid grid;
  const int step = DepthSampler::step_px;
  grid.columns = camera.width / step;
  grid.rows = camera.height / step;
  grid.samples.reserve(static_cast<std::size_t>(grid.columns) * static_cast<std::size_t>(grid.rows));
  for (int r = 0; r < grid.rows; ++r) {
    const int v = std::min(s.roles.height - 1, (2 * r + 1) * step * s.roles.height / (2 * camera.height));
    for (int c = 0; c < grid.columns; ++c) {
      const int u = std::min(s.roles.width - 1, (2 * c + 1) * step * s.roles.width / (2 * camera.width));
      LabelSample label;
      const std::uint8_t role = s.roles.at(u, v);
      require_input(role < surface_role_count, "segmentation: " + std::to_string(role) +
                                                   " is no role; they run from 0 to " +
                                                   std::to_string(surface_role_count - 1));
      label.role = static_cast<SurfaceRole>(role);
      label.confidence = s.confidence.empty() ? 1.0F : s.confidence.at(u, v);
      require_input(label.confidence >= 0 && label.confidence <= 1,
                    "segmentation: confidence must be 0 to 1");
      if (!s.instances.empty()) label.instance = s.instances.at(u, v);
      grid.samples.push_back(label);
    }
  }
  return grid;
}

}  // namespace vsgraphs
