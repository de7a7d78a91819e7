#include "core/scene/surfaces/up_direction.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "core/geometry/principal_axes.h"

namespace vsgraphs {
namespace {

enum class Stance { neither, upright, level };

Stance stance(const UprightEvidence& surface, const Eigen::Vector3d& up, double tolerance_rad) {
  const double sine = std::abs(surface.normal.dot(up));
  if (sine < std::sin(tolerance_rad)) return Stance::upright;
  if (sine > std::cos(tolerance_rad)) return Stance::level;
  return Stance::neither;
}

double support(const std::vector<UprightEvidence>& surfaces, const Eigen::Vector3d& up,
               double tolerance_rad) {
  double area = 0;
  for (const UprightEvidence& s : surfaces) {
    if (stance(s, up, tolerance_rad) != Stance::neither) area += s.area_m2;
  }
  return area;
}

// Least squares over all that agree: upright normals at right angles to it, level ones along it.
Eigen::Vector3d refine(const std::vector<UprightEvidence>& surfaces, const Eigen::Vector3d& up,
                       double tolerance_rad) {
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
  for (const UprightEvidence& s : surfaces) {
    const Eigen::Matrix3d outer = s.area_m2 * s.normal * s.normal.transpose();
    const Stance how = stance(s, up, tolerance_rad);
    if (how == Stance::upright) scatter += outer;
    if (how == Stance::level) scatter += s.area_m2 * Eigen::Matrix3d::Identity() - outer;
  }
  const Eigen::Vector3d refined = weakest_axis(scatter);
  return refined.dot(up) < 0 ? Eigen::Vector3d(-refined) : refined;
}

bool agreed(const std::vector<UprightEvidence>& surfaces, const Eigen::Vector3d& up,
            const UpDirectionOptions& options) {
  std::vector<Eigen::Vector3d> walls;
  for (const UprightEvidence& s : surfaces) {
    if (s.area_m2 < options.min_area_m2) continue;
    const Stance how = stance(s, up, options.tolerance_rad);
    if (how == Stance::level && s.below_the_camera && s.normal.dot(up) > 0) return true;
    if (how == Stance::upright) walls.push_back(s.normal);
  }
  constexpr double not_parallel = 0.35;  // sine of 20 deg
  for (const Eigen::Vector3d& a : walls) {
    for (const Eigen::Vector3d& b : walls) {
      if (a.cross(b).norm() > not_parallel) return true;
    }
  }
  return false;
}

}  // namespace

std::optional<Eigen::Vector3d> find_up(std::vector<UprightEvidence> surfaces, const Eigen::Vector3d& image_up,
                                       const UpDirectionOptions& options) {
  constexpr std::size_t largest = 24;
  std::stable_sort(surfaces.begin(), surfaces.end(),
                   [](const auto& a, const auto& b) { return a.area_m2 > b.area_m2; });
  if (surfaces.size() > largest) surfaces.resize(largest);
  std::vector<Eigen::Vector3d> candidates;
  const auto consider = [&](Eigen::Vector3d candidate) {
    if (candidate.norm() < 0.35) return;
    candidate.normalize();
    if (candidate.dot(image_up) < 0) candidate = -candidate;
    if (candidate.dot(image_up) > std::cos(options.max_tilt_rad)) candidates.push_back(candidate);
  };
  for (std::size_t i = 0; i < surfaces.size(); ++i) {
    consider(surfaces[i].normal);
    for (std::size_t j = i + 1; j < surfaces.size(); ++j)
      consider(surfaces[i].normal.cross(surfaces[j].normal));
  }
  double total = 0, most = 0;
  for (const UprightEvidence& s : surfaces) total += s.area_m2;
  Eigen::Vector3d best = image_up;
  for (const Eigen::Vector3d& candidate : candidates) {
    const double area = support(surfaces, candidate, options.tolerance_rad);
    if (area > most) most = area, best = candidate;
  }
  if (candidates.empty() || most < options.min_share * total) return std::nullopt;
  for (int i = 0; i < 3; ++i) best = refine(surfaces, best, options.tolerance_rad);
  if (!agreed(surfaces, best, options)) return std::nullopt;
  return best;
}

}  // namespace vsgraphs
