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

[[noreturn]] void refuse_collision(const std::string& a, const std::string& b) {
  throw InputError("segmentation: the class names '" + a + "' and '" + b +
                   "' have one number (FNV-1a, 32 bits); give one of them another name");
}

// Class k is the k-th of them, from 1 on; number 0 is none.
std::vector<ClassId> numbers_of(std::span<const std::string> names) {
  require_input(names.size() <= most_class_names,
                "segmentation: " + std::to_string(names.size()) + " class names; at most " +
                    std::to_string(most_class_names) + " can be told apart");
  std::vector<ClassId> numbers{{}};
  std::map<ClassId, const std::string*> first;
  for (const std::string& name : names) {
    if (!is_class_name(name))
      throw InputError("segmentation: the name of class " + std::to_string(numbers.size()) +
                       " must be a text of 1 to " + std::to_string(longest_class_name) +
                       " bytes (UTF-8) without control characters");
    numbers.push_back(class_id(name));
    const auto [at, fresh] = first.emplace(numbers.back(), &name);
    if (fresh) continue;
    require_input(*at->second != name, "segmentation: the class name '" + name + "' is there twice");
    refuse_collision(*at->second, name);
  }
  return numbers;
}

LabelSample sample_at(const Segmentation& s, int u, int v) {
  LabelSample label;
  const std::uint8_t role = s.roles.at(u, v);
  if (role >= surface_role_count)
    throw InputError("segmentation: " + std::to_string(role) + " is no role; they run from 0 to " +
                     std::to_string(surface_role_count - 1));
  label.role = static_cast<SurfaceRole>(role);
  label.confidence = s.confidence.empty() ? 1.0F : s.confidence.at(u, v);
  require_input(label.confidence >= 0 && label.confidence <= 1, "segmentation: confidence must be 0 to 1");
  if (!s.instances.empty()) label.instance = s.instances.at(u, v);
  return label;
}

void require_consistent(const Segmentation& s) {
  require_input(!s.roles.empty(), "segmentation: roles is empty");
  require_same_size(s.confidence, s, "confidence");
  require_same_size(s.instances, s, "instances");
  require_same_size(s.classes, s, "classes");
  require_input(s.classes.empty() || !s.class_names.empty(),
                "segmentation: classes without class_names; give them, class k is the k-th of them");
  require_input(!s.classes.empty() || s.class_names.empty(), "segmentation: class_names without classes");
}

}  // namespace

LabelGrid sample_labels(const Segmentation& s, const Camera& camera) {
  require_consistent(s);
  const std::vector<ClassId> numbers = numbers_of(s.class_names);
  std::vector<bool> occurs(numbers.size(), false);
  LabelGrid grid;
  const int step = DepthSampler::step_px;
  grid.columns = camera.width / step;
  grid.rows = camera.height / step;
  grid.samples.reserve(static_cast<std::size_t>(grid.columns) * static_cast<std::size_t>(grid.rows));
  for (int r = 0; r < grid.rows; ++r) {
    const int v = std::min(s.roles.height - 1, (2 * r + 1) * step * s.roles.height / (2 * camera.height));
    for (int c = 0; c < grid.columns; ++c) {
      const int u = std::min(s.roles.width - 1, (2 * c + 1) * step * s.roles.width / (2 * camera.width));
      LabelSample& label = grid.samples.emplace_back(sample_at(s, u, v));
      const std::size_t k = s.classes.empty() ? 0 : s.classes.at(u, v);
      if (k >= numbers.size())
        throw InputError("segmentation: class " + std::to_string(k) + " is beyond the " +
                         std::to_string(s.class_names.size()) + " of class_names");
      label.named = numbers[k];
      occurs[k] = true;
    }
  }
  for (std::size_t k = 1; k < numbers.size(); ++k)
    if (occurs[k]) grid.class_names.emplace(numbers[k], s.class_names[k - 1]);
  return grid;
}

void ClassRegister::take(const ClassNames& names) {
  const std::lock_guard lock(mutex_);
  for (const auto& [id, name] : names) {
    const auto known = known_.find(id);
    if (known != known_.end() && known->second != name) refuse_collision(known->second, name);
  }
  known_.insert(names.begin(), names.end());
}

}  // namespace vsgraphs
