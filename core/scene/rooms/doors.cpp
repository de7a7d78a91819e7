#include "core/scene/rooms/doors.h"

#include <algorithm>
#include <cmath>

namespace vsgraphs {
namespace {

constexpr double bin_m = 0.05;
constexpr double aside_m = 0.4;  // how far beyond its supposed edges an opening is measured
constexpr double top_m = 3.0;    // highest lintel
constexpr double jamb_low_m = 0.3, jamb_high_m = 1.9;

// Counts of rays by where they cross the middle of the wall.
struct Crossings {
  std::vector<int> along;   // by bins from -reach
  std::vector<int> jambs;   // rays that ended at the wall beside the opening, same bins
  std::vector<int> up;      // by bins from the ground, middle half of the opening only
  std::vector<int> lintel;  // rays that ended at the wall above it, same bins
  double reach_m = 0;
};

class DoorRays {
 public:
  DoorRays(const WallOpening& opening, double ground_m, const DoorOptions& options)
      : opening_(opening), ground_m_(ground_m), options_(options) {
    counts_.reach_m = 0.5 * opening.width_m + aside_m;
    counts_.along.assign(static_cast<std::size_t>(std::ceil(2 * counts_.reach_m / bin_m)), 0);
    counts_.jambs = counts_.along;
    counts_.up.assign(static_cast<std::size_t>(std::lround(top_m / bin_m)), 0);
    counts_.lintel = counts_.up;
  }

  // Can rays of this view have gone through?
  bool faced_by(const FreeSpace::View& view, double range_m) const {
    const Eigen::Vector3d camera = in_opening(view.level_from_camera.translation());
    const Eigen::Vector2d looks = view.level_from_camera.rotation().col(2).head<2>();
    const Eigen::Vector2d to = opening_.center - view.level_from_camera.translation().head<2>();
    return camera.head<2>().norm() <= range_m && camera.z() > -0.5 && camera.z() < top_m &&
           std::abs(camera.y()) > bin_m && looks.dot(to) > 0.5 * looks.norm() * to.norm();
  }

  void add(const FreeSpace::View& view) {
    const Eigen::Vector3d camera = in_opening(view.level_from_camera.translation());
    for (const SurfaceSample& sample :
         view.depth->samples)  // far ones too: where a ray crosses does not hang on them
      if (sample.point.z() > 0)
        add(camera, in_opening(view.level_from_camera * sample.point.cast<double>().eval()));
  }

  const Crossings& counts() const { return counts_; }

 private:
  // (along the wall, across it, above the ground).
  Eigen::Vector3d in_opening(const Eigen::Vector3d& p) const {
    const Eigen::Vector2d to = p.head<2>() - opening_.center;
    return {to.dot(opening_.along()), to.dot(opening_.normal), p.z() - ground_m_};
  }

  void add(const Eigen::Vector3d& camera, const Eigen::Vector3d& end) {
    const double half = 0.5 * opening_.thickness_m;
    const bool middle = std::abs(end.x()) < 0.25 * opening_.width_m;
    if (middle && std::abs(end.y()) <= half + 0.08) count(end.z(), 0, counts_.lintel);
    if (std::abs(end.y()) <= half + 0.04 && end.z() > jamb_low_m && end.z() < jamb_high_m)
      count(end.x(), counts_.reach_m, counts_.jambs);
    if (camera.y() * end.y() >= 0 || std::abs(end.y()) < half + options_.behind_m) return;
    const Eigen::Vector3d at = camera + (end - camera) * (camera.y() / (camera.y() - end.y()));
    if (at.z() > jamb_low_m && at.z() < jamb_high_m) count(at.x(), counts_.reach_m, counts_.along);
    if (std::abs(at.x()) < 0.25 * opening_.width_m) count(at.z(), 0, counts_.up);
  }

  static void count(double value, double from, std::vector<int>& bins) {
    const double bin = (value + from) / bin_m;
    if (bin >= 0 && bin < static_cast<double>(bins.size())) ++bins[static_cast<std::size_t>(bin)];
  }

  const WallOpening& opening_;
  double ground_m_;
  const DoorOptions& options_;
  Crossings counts_;
};

// First and last bin of the run of bins with enough rays around `start`; single empty bins are bridged.
std::array<int, 2> run_around(const std::vector<int>& bins, int start, int min_rays) {
  const auto enough = [&](int i) {
    return i >= 0 && i < static_cast<int>(bins.size()) && bins[static_cast<std::size_t>(i)] >= min_rays;
  };
  std::array<int, 2> run{start, start};
  while (enough(run[0] - 1) || enough(run[0] - 2)) --run[0];
  while (enough(run[1] + 1) || enough(run[1] + 2)) ++run[1];
  return run;
}

// The edge between the last bin rays passed and the first one beyond it where they ended at the wall; nothing if none did
// nearby. An open leaf keeps rays from passing close to its hinge: then the wall is believed half-way.
std::optional<double> edge_m(const std::vector<int>& ended, int last_passed, int step, int min_rays) {
  constexpr int reach = 4;
  for (int i = 1; i <= reach; ++i) {
    const int bin = last_passed + i * step;
    if (bin < 0 || bin >= static_cast<int>(ended.size())) break;
    if (ended[static_cast<std::size_t>(bin)] >= min_rays) return (last_passed + 0.5 + 0.5 * i * step) * bin_m;
  }
  return std::nullopt;
}

void measure(const Crossings& counts, const WallOpening& opening, const DoorOptions& options,
             FoundDoor& door) {
  const auto busiest = std::max_element(counts.along.begin(), counts.along.end());
  if (busiest == counts.along.end() || *busiest < options.min_rays) return;
  const std::array<int, 2> run =
      run_around(counts.along, static_cast<int>(busiest - counts.along.begin()), options.min_rays);
  const double from =
      edge_m(counts.jambs, run[0], -1, options.min_rays).value_or(run[0] * bin_m) - counts.reach_m;
  const double to =
      edge_m(counts.jambs, run[1], 1, options.min_rays).value_or((run[1] + 1) * bin_m) - counts.reach_m;
  door.width_m = to - from;
  door.position.head<2>() += 0.5 * (from + to) * opening.along();

  const auto eye = static_cast<int>(std::lround(1.3 / bin_m));
  const int top = run_around(counts.up, eye, options.min_rays)[1];
  door.height_m = edge_m(counts.lintel, top, 1, options.min_rays);
}

}  // namespace

std::vector<FoundDoor> find_doors(const LevelMap& map, const Clusters& clusters, const RoomsOfLevel& rooms,
                                  std::span<const FreeSpace::View> views, const DoorOptions& options) {
  std::vector<FoundDoor> doors;
  const auto room_of = [&](int cluster) {
    return cluster < 0 ? -1 : rooms.room_of_cluster[static_cast<std::size_t>(cluster)];
  };
  for (const ClusterOpening& o : clusters.openings) {
    const int behind = room_of(o.clusters[0]), before = room_of(o.clusters[1]);
    if (behind < 0 || before < 0 || behind == before) continue;
    FoundDoor door;
    door.position << o.opening.center, map.ground_m;
    door.normal << o.opening.normal, 0;
    door.width_m = o.opening.width_m;
    door.thickness_m = o.opening.thickness_m;
    door.rooms = {rooms.rooms[static_cast<std::size_t>(behind)].number,
                  rooms.rooms[static_cast<std::size_t>(before)].number};
    DoorRays rays(o.opening, map.ground_m, options);
    std::vector<const FreeSpace::View*> facing;
    for (const FreeSpace::View& view : views)
      if (view.depth && rays.faced_by(view, options.range_m)) facing.push_back(&view);
    // Spread over all of them, so that many do not cost more.
    const std::size_t used = std::min(facing.size(), static_cast<std::size_t>(options.max_keyframes));
    for (std::size_t i = 0; i < used; ++i) rays.add(*facing[i * facing.size() / used]);
    measure(rays.counts(), o.opening, options, door);
    doors.push_back(door);
  }
  return doors;
}

}  // namespace vsgraphs
