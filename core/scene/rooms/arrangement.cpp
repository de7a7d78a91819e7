#include "core/scene/rooms/arrangement.h"

#include <cmath>

#include "core/base/check.h"

namespace vsgraphs {
namespace {

double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }

// The part of a convex face on the positive side of `sign` times the line; no corners if there is none.
Arrangement::Face clipped(const Arrangement::Face& face, const PlanLine& line, int index, double sign) {
  Arrangement::Face part;
  part.sides = face.sides | (sign > 0 ? 1u << index : 0u);
  const std::size_t n = face.corners.size();
  for (std::size_t i = 0; i < n; ++i) {
    const Eigen::Vector2d &a = face.corners[i], &b = face.corners[(i + 1) % n];
    const double da = sign * line.distance(a), db = sign * line.distance(b);
    if (da > 0) {
      part.corners.push_back(a);
      part.lines.push_back(face.lines[i]);
    }
    if ((da > 0) == (db > 0)) continue;
    // Computed from the same end whichever part is asked for, so that neighbours share their corners exactly.
    const double share = std::abs(da) / (std::abs(da) + std::abs(db));
    part.corners.push_back(a + share * (b - a));
    part.lines.push_back(da > 0 ? index : face.lines[i]);
  }
  return part;
}

// Loops of directed edges; where several go on from a corner, the leftmost turn, which keeps pieces that touch at a corner
// apart.
std::vector<std::vector<OutlineEdge>> loops_of(std::vector<OutlineEdge> edges) {
  constexpr double same_m = 1e-6;
  std::vector<std::vector<OutlineEdge>> loops;
  while (!edges.empty()) {
    std::vector<OutlineEdge> loop{edges.back()};
    edges.pop_back();
    for (;;) {
      const Eigen::Vector2d way = loop.back().to - loop.back().from;
      std::size_t best = edges.size();
      double best_turn = -4;
      for (std::size_t i = 0; i < edges.size(); ++i) {
        if ((edges[i].from - loop.back().to).norm() > same_m) continue;
        const Eigen::Vector2d next = edges[i].to - edges[i].from;
        const double turn = std::atan2(cross(way, next), way.dot(next));
        if (turn > best_turn) {
          best = i;
          best_turn = turn;
        }
      }
      if (best == edges.size()) break;
      loop.push_back(edges[best]);
      edges.erase(edges.begin() + static_cast<std::ptrdiff_t>(best));
    }
    loops.push_back(std::move(loop));
  }
  return loops;
}

double area_of(const std::vector<OutlineEdge>& loop) {
  double twice = 0;
  for (const OutlineEdge& edge : loop) twice += cross(edge.from - loop[0].from, edge.to - loop[0].from);
  return 0.5 * twice;
}

std::vector<OutlineEdge> joined(const std::vector<OutlineEdge>& loop) {
  std::vector<OutlineEdge> edges;
  for (const OutlineEdge& edge : loop) {
    if (!edges.empty() && edges.back().line == edge.line && edge.line >= 0)
      edges.back().to = edge.to;
    else
      edges.push_back(edge);
  }
  if (edges.size() > 1 && edges.front().line == edges.back().line && edges.front().line >= 0) {
    edges.front().from = edges.back().from;
    edges.pop_back();
  }
  return edges;
}

}  // namespace

Arrangement::Arrangement(const Eigen::Vector2d& low, const Eigen::Vector2d& high,
                         const std::vector<PlanLine>& lines)
    : lines_(lines) {
  VSG_INVARIANT(lines.size() <= max_lines);
  faces_.push_back({{low, {high.x(), low.y()}, high, {low.x(), high.y()}}, {-1, -1, -1, -1}, 0});
  for (int i = 0; i < static_cast<int>(lines_.size()); ++i) split_by(i);
  for (int i = 0; i < static_cast<int>(faces_.size()); ++i)
    face_by_sides_[faces_[static_cast<std::size_t>(i)].sides] = i;
}

void Arrangement::split_by(int line) {
  std::vector<Face> parts;
  for (const Face& face : faces_)
    for (const double sign : {1.0, -1.0}) {
      Face part = clipped(face, lines_[static_cast<std::size_t>(line)], line, sign);
      if (part.corners.size() >= 3) parts.push_back(std::move(part));
    }
  faces_ = std::move(parts);
}

int Arrangement::face_at(const Eigen::Vector2d& point) const {
  std::uint32_t sides = 0;
  for (std::size_t i = 0; i < lines_.size(); ++i)
    if (lines_[i].distance(point) > 0) sides |= 1u << i;
  const auto it = face_by_sides_.find(sides);
  return it == face_by_sides_.end() ? -1 : it->second;
}

int Arrangement::neighbour(int face, int edge) const {
  const Face& f = faces_[static_cast<std::size_t>(face)];
  const int line = f.lines[static_cast<std::size_t>(edge)];
  if (line < 0) return -1;
  const auto it = face_by_sides_.find(f.sides ^ (1u << line));
  return it == face_by_sides_.end() ? -1 : it->second;
}

std::vector<OutlineEdge> Arrangement::outline(const std::vector<char>& inside) const {
  std::vector<OutlineEdge> edges;
  for (int f = 0; f < static_cast<int>(faces_.size()); ++f) {
    if (!inside[static_cast<std::size_t>(f)]) continue;
    const Face& face = faces_[static_cast<std::size_t>(f)];
    for (std::size_t e = 0; e < face.corners.size(); ++e) {
      const int other = neighbour(f, static_cast<int>(e));
      if (other >= 0 && inside[static_cast<std::size_t>(other)]) continue;
      edges.push_back({face.corners[e], face.corners[(e + 1) % face.corners.size()], face.lines[e]});
    }
  }
  std::vector<OutlineEdge> best;
  for (const std::vector<OutlineEdge>& loop : loops_of(std::move(edges)))
    if (best.empty() || area_of(loop) > area_of(best)) best = loop;
  return joined(best);
}

}  // namespace vsgraphs
