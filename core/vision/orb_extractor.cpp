#include "core/vision/orb_extractor.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "core/base/check.h"

namespace vsgraphs {
namespace {

// Levels smaller than this carry no features: their border would be all there is.
constexpr int smallest_level_px = 64;
constexpr int border_px = patch_reach_px + 1;

void require_range(double value, double low, double high, const char* name) {
  require_input(value >= low && value <= high, std::string("orb: ") + name + " must lie in " +
                                                   std::to_string(low) + ".." + std::to_string(high) +
                                                   ", not " + std::to_string(value));
}

void require_size(int width, int height, const Camera& camera, const char* what) {
  require_input(width == camera.width && height == camera.height,
                std::string(what) + ": the image is " + std::to_string(width) + "x" + std::to_string(height) +
                    " but the camera says " + std::to_string(camera.width) + "x" +
                    std::to_string(camera.height) + "; correct the camera's width and height");
}

// A level's share falls with its size in one dimension, so that coarse levels keep enough to be matched from
// afar.
std::vector<int> shares(const OrbOptions& options) {
  std::vector<int> wanted;
  double sum = 0;
  for (int i = 0; i < options.levels; ++i) sum += std::pow(options.scale_factor, -i);
  int left = options.max_features;
  for (int i = 0; i < options.levels; ++i) {
    const double share = options.max_features * std::pow(options.scale_factor, -i) / sum;
    wanted.push_back(i + 1 == options.levels ? left : std::min(left, static_cast<int>(std::lround(share))));
    left -= wanted.back();
  }
  return wanted;
}

const Camera& checked(const Camera& camera) {
  camera.validate();
  return camera;
}

const OrbOptions& checked(const OrbOptions& options) {
  options.validate();
  return options;
}

}  // namespace

void OrbOptions::validate() const {
  require_range(max_features, 1, 20000, "max_features");
  require_range(levels, 1, 16, "levels");
  require_range(scale_factor, 1.05, 2.0, "scale_factor");
  require_range(fast_threshold, 2, 254, "fast_threshold");
  require_range(fast_threshold_low, 1, fast_threshold, "fast_threshold_low");
}

OrbExtractor::OrbExtractor(const OrbOptions& options, const Camera& camera)
    : options_(checked(options)),
      camera_(checked(camera)),
      scales_(options.pyramid()),
      wanted_(shares(options)),
      grey_(scales_, camera.width, camera.height),
      brief_(grey_.blurred_stride()),
      depth_(camera),
      undistort_(camera) {}

FeatureSet OrbExtractor::extract(const ImageView<std::uint8_t>& grey, const DepthView& depth,
                                 const ImageView<Rgb>& colour) {
  require_input(!grey.empty(), "orb: the grey image is empty; give an image of the camera's size");
  require_size(grey.width, grey.height, camera_, "orb, grey");
  if (!colour.empty()) require_size(colour.width, colour.height, camera_, "orb, colour");
  depth_.validate(depth);

  grey_.build(grey);
  find_keypoints();
  std::vector<Feature> features;
  std::vector<Descriptor> descriptors;
  features.reserve(keypoints_.size());
  descriptors.reserve(keypoints_.size());
  for (const Keypoint& keypoint : keypoints_) {
    Feature feature = place(keypoint, depth, colour);
    feature.angle_rad = patch_angle(grey_.level(keypoint.level), keypoint.corner.x, keypoint.corner.y);
    descriptors.push_back(brief_.describe(grey_.blurred(keypoint.level), keypoint.corner.x, keypoint.corner.y,
                                          feature.angle_rad));
    features.push_back(feature);
  }
  return {std::move(features), std::move(descriptors), camera_.width, camera_.height};
}

void OrbExtractor::find_keypoints() {
  keypoints_.clear();
  int missing = 0;  // what a level could not give is asked of the next one
  for (int i = 0; i < scales_.levels; ++i) {
    const ImageView<std::uint8_t>& level = grey_.level(i);
    const int wanted = wanted_[static_cast<std::size_t>(i)] + missing;
    chosen_.clear();
    if (std::min(level.width, level.height) >= smallest_level_px) {
      fast_.detect(level, options_.fast_threshold_low, border_px, corners_);
      spread_.choose(corners_, level.width, level.height, wanted, options_.fast_threshold, chosen_);
    }
    missing = wanted - static_cast<int>(chosen_.size());
    for (const ChosenCorner& c : chosen_) {
      const std::uint64_t order = std::uint64_t{c.rank} << 48 | std::uint64_t{255u - c.corner.score} << 40 |
                                  static_cast<std::uint64_t>(keypoints_.size());
      keypoints_.push_back({order, c.corner, static_cast<std::uint8_t>(i)});
    }
  }
  std::sort(keypoints_.begin(), keypoints_.end(),
            [](const Keypoint& a, const Keypoint& b) { return a.order < b.order; });
}

Feature OrbExtractor::place(const Keypoint& keypoint, const DepthView& depth,
                            const ImageView<Rgb>& colour) const {
  const ImageView<std::uint8_t>& level = grey_.level(keypoint.level);
  const SubpixelShift shift = refine(level, keypoint.corner);
  // Levels are aligned by their edges, half a pixel before the first centre.
  const auto to_level_0 = [](int pixel, float part, int full_size, int size) {
    return (static_cast<float>(pixel) + part + 0.5f) * static_cast<float>(full_size) /
               static_cast<float>(size) -
           0.5f;
  };
  const float u = to_level_0(keypoint.corner.x, shift.x, camera_.width, level.width);
  const float v = to_level_0(keypoint.corner.y, shift.y, camera_.height, level.height);
  const Eigen::Vector2f undistorted = undistort_.at(u, v);
  Feature feature;
  feature.u = undistorted.x();
  feature.v = undistorted.y();
  feature.level = keypoint.level;
  feature.depth_m = static_cast<float>(depth_.at(depth, u, v));
  if (!colour.empty())
    feature.colour = colour.at(static_cast<int>(std::lround(u)), static_cast<int>(std::lround(v)));
  return feature;
}

}  // namespace vsgraphs
