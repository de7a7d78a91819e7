#include "core/scene/surfaces/plane_extraction.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <tuple>

#include "core/base/check.h"
#include "core/geometry/plane_fit.h"

namespace vsgraphs {
namespace {

constexpr int unassigned = -1, unusable = -2;

class Extraction {
 public:
  Extraction(const DepthGrid& grid, const LabelGrid* labels, const Camera& camera,
             const PlaneExtractionOptions& options)
      : grid_(grid),
        labels_(labels),
        camera_(camera),
        options_(options),
        region_(grid.samples.size(), unassigned) {
    for (std::size_t i = 0; i < region_.size(); ++i) {
      const double z = static_cast<double>(grid.samples[i].point.z());
      if (z < options.min_range_m || z > options.max_range_m) region_[i] = unusable;
    }
  }

  KeyframeSurfaces run() {
    KeyframeSurfaces surfaces;
    surfaces.labelled = labels_ != nullptr;
    for (const int seed : seeds()) {
      if (region_[static_cast<std::size_t>(seed)] != unassigned) continue;
      if (auto patch = patch_from(seed)) surfaces.patches.push_back(std::move(*patch));
    }
    return surfaces;
  }

 private:
  // Where the surface is smoothest around, first: a region that starts on an edge grows along a wrong plane.
  std::vector<int> seeds() const;
  std::optional<SurfacePatch> patch_from(int seed);
  std::vector<int> grow(int seed, const AnchoredPlane& plane, bool refit) const;
  bool belongs(std::size_t i, const AnchoredPlane& plane, const LabelSample& label) const;
  LabelSample label(std::size_t i) const {
    if (!labels_ || static_cast<double>(labels_->samples[i].confidence) < options_.min_confidence) return {};
    return labels_->samples[i];
  }
  std::optional<PlaneFit> fit(const std::vector<int>& members, const Eigen::Vector3d& normal) const;
  SurfacePatch condense(const std::vector<int>& members, const PlaneFit& fit) const;
  Eigen::Vector3d point(std::size_t i) const { return grid_.samples[i].point.cast<double>(); }

  const DepthGrid& grid_;
  const LabelGrid* labels_;
  const Camera& camera_;
  const PlaneExtractionOptions& options_;
  std::vector<int> region_;  // number of the patch each sample went to
  int next_region_ = 0;
};

std::vector<int> Extraction::seeds() const {
  constexpr int reach = 2;
  std::vector<std::pair<float, int>> rated;
  for (int r = reach; r < grid_.rows - reach; ++r) {
    for (int c = reach; c < grid_.columns - reach; ++c) {
      const SurfaceSample& middle = grid_.at(c, r);
      const int i = r * grid_.columns + c;
      if (region_[static_cast<std::size_t>(i)] != unassigned || !middle.has_normal()) continue;
      float bent = 0;
      bool whole = true;
      for (const auto& [dc, dr] : {std::pair{reach, 0}, {-reach, 0}, {0, reach}, {0, -reach}}) {
        const SurfaceSample& other = grid_.at(c + dc, r + dr);
        whole = whole && other.has_normal();
        bent = std::max(bent, 1 - middle.normal.dot(other.normal));
      }
      // In coarse steps, so that among equally smooth ones the order is that of the image.
      if (whole) rated.emplace_back(std::floor(bent * 50), i);
    }
  }
  std::sort(rated.begin(), rated.end());
  std::vector<int> order;
  order.reserve(rated.size());
  for (const auto& [bent, i] : rated) order.push_back(i);
  return order;
}

bool Extraction::belongs(std::size_t i, const AnchoredPlane& plane, const LabelSample& seed) const {
  if (region_[i] != unassigned) return false;
  const SurfaceSample& sample = grid_.samples[i];
  const Eigen::Vector3d p = point(i);
  const double gate = options_.gate_sigmas * normal_sigma_m(camera_, {}, p, plane.normal);
  if (std::abs(plane.signed_distance(p)) > gate) return false;
  if (sample.has_normal() &&
      static_cast<double>(sample.normal.dot(plane.normal.cast<float>())) < std::cos(options_.max_turn_rad))
    return false;
  const LabelSample own = label(i);
  if (own.role == SurfaceRole::undecided || seed.role == SurfaceRole::undecided) return true;
  return own.role == seed.role && own.instance == seed.instance;
}

// Breadth first over the four neighbours; single missing samples are stepped over.
std::vector<int> Extraction::grow(int seed, const AnchoredPlane& start, bool refit) const {
  AnchoredPlane plane = start;
  const LabelSample seed_label = label(static_cast<std::size_t>(seed));
  std::vector<std::uint8_t> visited(region_.size(), 0);
  std::vector<int> members{seed};
  visited[static_cast<std::size_t>(seed)] = 1;
  std::size_t next_refit = 24;
  for (std::size_t at = 0; at < members.size(); ++at) {
    if (refit && members.size() >= next_refit) {
      if (const auto better = fit(members, plane.normal)) plane = better->estimate.plane;
      next_refit *= 2;
    }
    const int c = members[at] % grid_.columns, r = members[at] / grid_.columns;
    for (const auto& [dc, dr] :
         {std::pair{1, 0}, {-1, 0}, {0, 1}, {0, -1}, {2, 0}, {-2, 0}, {0, 2}, {0, -2}}) {
      if (c + dc < 0 || r + dr < 0 || c + dc >= grid_.columns || r + dr >= grid_.rows) continue;
      const auto i = static_cast<std::size_t>((r + dr) * grid_.columns + c + dc);
      if (visited[i] || !belongs(i, plane, seed_label)) continue;
      visited[i] = 1;
      members.push_back(static_cast<int>(i));
    }
  }
  return members;
}

std::optional<PlaneFit> Extraction::fit(const std::vector<int>& members,
                                        const Eigen::Vector3d& normal) const {
  PlaneSums sums;
  for (const int m : members) {
    const Eigen::Vector3d p = point(static_cast<std::size_t>(m));
    const double sigma = normal_sigma_m(camera_, {}, p, normal);
    sums.add(p, 1 / (sigma * sigma));
  }
  return sums.fit(options_.effective_samples);
}

std::optional<SurfacePatch> Extraction::patch_from(int seed) {
  const SurfaceSample& s = grid_.samples[static_cast<std::size_t>(seed)];
  const AnchoredPlane start{s.normal.cast<double>().normalized(), s.point.cast<double>(), 0};
  std::vector<int> members = grow(seed, start, true);
  std::optional<PlaneFit> fitted;
  if (static_cast<int>(members.size()) >= options_.min_samples / 2) fitted = fit(members, start.normal);
  if (fitted) {
    // Again from the start, by the plane the whole region agreed on.
    members = grow(seed, fitted->estimate.plane, false);
    fitted = fit(members, fitted->estimate.plane.normal);
  }
  const bool enough = fitted && static_cast<int>(members.size()) >= options_.min_samples;
  if (!enough) {
    region_[static_cast<std::size_t>(seed)] = unusable;
    return std::nullopt;
  }
  for (const int m : members) region_[static_cast<std::size_t>(m)] = next_region_;
  ++next_region_;
  SurfacePatch patch = condense(members, *fitted);
  if (static_cast<double>(patch.area_m2) < options_.min_area_m2) return std::nullopt;
  return patch;
}

SurfacePatch Extraction::condense(const std::vector<int>& members, const PlaneFit& fitted) const {
  SurfacePatch patch;
  patch.plane = fitted.estimate.plane;
  patch.information = fitted.estimate.information;
  patch.samples = static_cast<int>(members.size());
  const auto spacing = static_cast<float>(options_.point_spacing_m);
  std::set<std::tuple<int, int, int>> taken;
  std::map<ClassId, float> named;
  const double solid_angle = grid_.step_px * grid_.step_px / (camera_.fx * camera_.fy);
  double area = 0;
  for (const int m : members) {
    const auto i = static_cast<std::size_t>(m);
    const Eigen::Vector3d p = point(i);
    // What the sample's cone cuts out of the plane.
    area +=
        solid_angle * p.z() * p.z() * p.z() / std::max(0.05 * p.norm(), std::abs(patch.plane.normal.dot(p)));
    const Eigen::Vector3f on_plane = patch.plane.project(p).cast<float>();
    const Eigen::Array3i voxel = (on_plane.array() / spacing).floor().cast<int>();
    if (taken.insert({voxel.x(), voxel.y(), voxel.z()}).second) patch.points.push_back(on_plane);
    const LabelSample l = label(i);
    if (l.role != SurfaceRole::undecided) patch.votes[static_cast<std::size_t>(l.role)] += l.confidence;
    if (!l.named.none()) named[l.named] += l.confidence;
  }
  patch.area_m2 = static_cast<float>(area);
  // One vote per keyframe, shared among the roles, and the classes, its pixels name.
  for (float& vote : patch.votes) vote /= static_cast<float>(members.size());
  for (const auto& [id, sum] : named)
    patch.class_votes.push_back({id, sum / static_cast<float>(members.size())});
  return patch;
}

}  // namespace

KeyframeSurfaces extract_planes(const DepthGrid& grid, const LabelGrid* labels, const Camera& camera,
                                const PlaneExtractionOptions& options) {
  VSG_INVARIANT(!labels || labels->samples.size() == grid.samples.size());
  return Extraction(grid, labels, camera, options).run();
}

}  // namespace vsgraphs
