#include "core/scene/rooms/wall_line.h"

#include <algorithm>
#include <cmath>

namespace vsgraphs {
namespace {

constexpr double max_tilt_sine = 0.42;  // 25 deg: what classification lets pass, with room to spare
constexpr double bridged_m = 0.35;      // pictures and narrow furniture leave such gaps; doors are wider

void bridge(std::vector<char>& seen, int max_gap) {
  int last = -1;
  for (int i = 0; i < static_cast<int>(seen.size()); ++i) {
    if (!seen[static_cast<std::size_t>(i)]) continue;
    if (last >= 0 && i - last - 1 <= max_gap) std::fill(seen.begin() + last, seen.begin() + i, char{1});
    last = i;
  }
}

}  // namespace

std::optional<WallLine> WallLine::from_face(const SceneFace& face, double ground_m,
                                            const LevelOptions& options) {
  if (std::abs(face.plane.normal.z()) > max_tilt_sine) return std::nullopt;
  WallLine line;
  line.id_ = face.id;
  line.normal_ = face.plane.normal.head<2>().normalized();
  // Where the plane stands at eye level: a wall that leans a little is not shifted by it.
  const Eigen::Vector3d eye(face.plane.anchor.x(), face.plane.anchor.y(), ground_m + options.furniture_m);
  line.offset_m_ = -line.normal_.dot(face.plane.project(eye).head<2>());
  line.from_m_ = 1e9;
  line.to_m_ = -1e9;
  for (const Eigen::Vector3f& p : face.points) {
    if (p.z() < ground_m || p.z() > ground_m + options.wall_high_m) continue;
    const double t = line.coordinate(p.head<2>().cast<double>());
    line.from_m_ = std::min(line.from_m_, t);
    line.to_m_ = std::max(line.to_m_, t);
  }
  if (line.from_m_ > line.to_m_) return std::nullopt;
  line.mark(face.points, ground_m, ground_m + options.wall_high_m, line.seen_);
  line.mark(face.points, ground_m + options.band_low_m, ground_m + head_m(options), line.seen_in_band_);
  return line;
}

void WallLine::mark(std::span<const Eigen::Vector3f> points, double low_m, double high_m,
                    std::vector<char>& seen) const {
  seen.assign(static_cast<std::size_t>(std::floor((to_m_ - from_m_) / bin_m)) + 1, 0);
  for (const Eigen::Vector3f& p : points) {
    if (p.z() < low_m || p.z() > high_m) continue;
    const double bin = (coordinate(p.head<2>().cast<double>()) - from_m_) / bin_m;
    if (bin >= 0 && bin < static_cast<double>(seen.size())) seen[static_cast<std::size_t>(bin)] = 1;
  }
  bridge(seen, static_cast<int>(bridged_m / bin_m));
}

double WallLine::seen_m(double from, double to, bool in_band) const {
  const std::vector<char>& seen = in_band ? seen_in_band_ : seen_;
  double sum = 0;
  const int first = std::max(0, static_cast<int>(std::floor((from - from_m_) / bin_m)));
  for (int i = first; i < static_cast<int>(seen.size()) && from_m_ + i * bin_m < to; ++i) {
    const double low = std::max(from, from_m_ + i * bin_m), high = std::min(to, from_m_ + (i + 1) * bin_m);
    if (seen[static_cast<std::size_t>(i)]) sum += std::max(0.0, high - low);
  }
  return sum;
}

std::vector<WallLine> wall_lines(std::span<const SceneFace> walls, double ground_m,
                                 const LevelOptions& options) {
  std::vector<WallLine> lines;
  for (const SceneFace& face : walls)
    if (std::optional<WallLine> line = WallLine::from_face(face, ground_m, options))
      lines.push_back(std::move(*line));
  return lines;
}

}  // namespace vsgraphs
