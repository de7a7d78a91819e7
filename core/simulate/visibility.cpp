#include "core/simulate/visibility.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace vsgraphs {
namespace {

constexpr double near_m = 0.02;
// Spans grow by this much so that rounding cannot open a crack between faces that share an edge.
constexpr double span_margin_px = 1e-6;

}  // namespace

FaceView face_view(const Face& face, const View& view) {
  const Camera& k = *view.camera;
  const Eigen::Matrix3d& r = view.camera_from_world.rotation();
  const Eigen::Vector3d origin = view.camera_from_world * face.origin;
  const auto form = [&](const Eigen::Vector3d& g) {
    // g . ((u + offset_u - cx) / fx, (v + offset_v - cy) / fy, 1)
    const double a = g.x() / k.fx, b = g.y() / k.fy;
    return PixelForm<double>{a, b, g.z() + a * (view.offset_u - k.cx) + b * (view.offset_v - k.cy)};
  };
  const Eigen::Vector3d s = r * face.s_axis, t = r * face.t_axis, n = s.cross(t);
  FaceView out;
  out.inverse_depth = form(n / n.dot(origin));
  out.s_over_z = form(s), out.t_over_z = form(t);
  out.s_shift = s.dot(origin), out.t_shift = t.dot(origin);
  return out;
}

VisibilityBuffer::VisibilityBuffer(int width, int height)
    : width_(width),
      height_(height),
      inverse_depths_(static_cast<std::size_t>(width) * height),
      faces_(inverse_depths_.size()) {}

void VisibilityBuffer::add_contour(const Polygon2& contour, const Face& face, const View& view) {
  const Camera& k = *view.camera;
  const Eigen::Matrix3d& r = view.camera_from_world.rotation();
  const Eigen::Vector3d o = view.camera_from_world * face.origin, s = r * face.s_axis, t = r * face.t_axis;
  const auto corner = [&](std::size_t i) -> Eigen::Vector3d {
    return o + contour[i].x() * s + contour[i].y() * t;
  };
  clipped_.clear();
  Eigen::Vector3d a = corner(contour.size() - 1);
  for (std::size_t i = 0; i < contour.size(); ++i) {
    const Eigen::Vector3d b = corner(i);
    if ((a.z() >= near_m) != (b.z() >= near_m))
      clipped_.push_back(a + (near_m - a.z()) / (b.z() - a.z()) * (b - a));
    if (b.z() >= near_m) clipped_.push_back(b);
    a = b;
  }
  const auto pixel = [&](const Eigen::Vector3d& p) -> Eigen::Vector2d {
    return {k.fx * p.x() / p.z() + k.cx - view.offset_u, k.fy * p.y() / p.z() + k.cy - view.offset_v};
  };
  for (std::size_t i = 0; i < clipped_.size(); ++i) {
    Eigen::Vector2d p = pixel(clipped_[i]), q = pixel(clipped_[(i + 1) % clipped_.size()]);
    bounds_[0] = std::min(bounds_[0], p.x()), bounds_[1] = std::max(bounds_[1], p.x());
    bounds_[2] = std::min(bounds_[2], p.y()), bounds_[3] = std::max(bounds_[3], p.y());
    if (p.y() > q.y()) std::swap(p, q);
    if (q.y() <= 0 || p.y() > height_ - 1) continue;  // crosses no row
    edges_.push_back({p.y(), q.y(), p.x(), (q.x() - p.x()) / std::max(q.y() - p.y(), 1e-300)});
  }
}

bool VisibilityBuffer::project(const Face& face, const View& view) {
  edges_.clear();
  constexpr double far = std::numeric_limits<double>::max();
  bounds_[0] = bounds_[2] = far;
  bounds_[1] = bounds_[3] = -far;
  for (const Polygon2& contour : face.contours) add_contour(contour, face, view);
  return !edges_.empty() && bounds_[0] < width_ && bounds_[1] > -1 && bounds_[2] < height_ && bounds_[3] > -1;
}

void VisibilityBuffer::fill(std::int32_t index, const FaceView& face_view) {
  const int v0 = static_cast<int>(std::ceil(std::max(bounds_[2], 0.0)));
  const int v1 = static_cast<int>(std::floor(std::min(bounds_[3], height_ - 1.0)));
  const float step = static_cast<float>(face_view.inverse_depth.a);
  for (int v = v0; v <= v1; ++v) {
    crossings_.clear();
    for (const Edge& e : edges_)
      if (e.v_min <= v && v < e.v_max) crossings_.push_back(e.u_at_v_min + (v - e.v_min) * e.slope);
    std::sort(crossings_.begin(), crossings_.end());
    float* depth = inverse_depths_.data() + static_cast<std::ptrdiff_t>(v) * width_;
    std::int32_t* face = faces_.data() + static_cast<std::ptrdiff_t>(v) * width_;
    const float start = static_cast<float>(face_view.inverse_depth.b * v + face_view.inverse_depth.c);
    for (std::size_t i = 0; i + 1 < crossings_.size(); i += 2) {
      const double left = std::max(0.0, std::ceil(crossings_[i] - span_margin_px));
      const double right = std::min(width_ - 1.0, std::floor(crossings_[i + 1] + span_margin_px));
      if (right < left) continue;
      const int u1 = static_cast<int>(right);
      for (int u = static_cast<int>(left); u <= u1; ++u) {
        const float z = start + step * static_cast<float>(u);
        const bool nearer = z > depth[u];
        depth[u] = nearer ? z : depth[u];
        face[u] = nearer ? index : face[u];
      }
    }
  }
}

void VisibilityBuffer::draw(const Scene& scene, const View& view, const std::vector<bool>& rooms) {
  std::fill(inverse_depths_.begin(), inverse_depths_.end(), 0.0f);
  std::fill(faces_.begin(), faces_.end(), -1);
  views_.resize(scene.faces.size());
  const Eigen::Vector3d eye = view.camera_from_world.inverse().translation();
  const Eigen::Vector3d axis = view.camera_from_world.rotation().row(2);
  for (std::size_t i = 0; i < scene.faces.size(); ++i) {
    const Face& face = scene.faces[i];
    if (face.room >= 0 && !rooms[static_cast<std::size_t>(face.room)]) continue;
    const Eigen::Vector3d to = face.origin - eye;
    if (face.normal().dot(to) >= -1e-9) continue;   // seen from behind
    if (axis.dot(to) < -face.size.sum()) continue;  // wholly behind the camera
    if (!project(face, view)) continue;
    views_[i] = face_view(face, view);
    fill(static_cast<std::int32_t>(i), views_[i]);
  }
}

namespace {

struct Window {  // part of the image
  double u0, v0, u1, v1;
};

// The part of `window` a doorway fills; false if none of it.
bool through_door(const DoorGeometry& door, const View& view, Window& window) {
  const Camera& k = *view.camera;
  const Eigen::Vector2d along(-door.normal.y(), door.normal.x());
  Window seen{1e9, 1e9, -1e9, -1e9};
  int behind = 0;
  for (const double side : {-0.5, 0.5}) {
    for (const double z : {door.z, door.z + door.height}) {
      const Eigen::Vector2d p = door.center + side * door.width * along;
      const Eigen::Vector3d c = view.camera_from_world * Eigen::Vector3d(p.x(), p.y(), z);
      if (c.z() < near_m) {
        ++behind;
        continue;
      }
      const double u = k.fx * c.x() / c.z() + k.cx, v = k.fy * c.y() / c.z() + k.cy;
      seen = {std::min(seen.u0, u), std::min(seen.v0, v), std::max(seen.u1, u), std::max(seen.v1, v)};
    }
  }
  if (behind == 4) return false;
  if (behind > 0) return true;  // reaches past the camera: no narrower bound
  window = {std::max(window.u0, seen.u0 - 1), std::max(window.v0, seen.v0 - 1),
            std::min(window.u1, seen.u1 + 1), std::min(window.v1, seen.v1 + 1)};
  return window.u0 < window.u1 && window.v0 < window.v1;
}

void visit(const Scene& scene, const View& view, int room, const Window& window, std::vector<bool>& seen,
           std::vector<bool>& passed) {
  seen[static_cast<std::size_t>(room)] = true;
  for (std::size_t i = 0; i < scene.doors.size(); ++i) {
    const DoorGeometry& door = scene.doors[i];
    if (passed[i] || (door.rooms[0] != room && door.rooms[1] != room)) continue;
    Window narrowed = window;
    if (!through_door(door, view, narrowed)) continue;
    passed[i] = true;  // a line of sight passes a doorway at most once
    visit(scene, view, door.rooms[0] == room ? door.rooms[1] : door.rooms[0], narrowed, seen, passed);
    passed[i] = false;
  }
}

}  // namespace

std::vector<bool> visible_rooms(const Scene& scene, const View& view) {
  const Eigen::Vector3d eye = view.camera_from_world.inverse().translation();
  const Window image{-1, -1, static_cast<double>(view.camera->width),
                     static_cast<double>(view.camera->height)};
  std::vector<bool> seen(scene.rooms.size(), false), passed(scene.doors.size(), false);
  bool inside = false;
  for (std::size_t r = 0; r < scene.rooms.size(); ++r) {
    const RoomPlan& room = scene.plan.rooms[r];
    if (!contains(room.polygon, eye.head<2>()) || eye.z() < room.z_floor ||
        eye.z() > room.z_floor + room.height)
      continue;
    visit(scene, view, static_cast<int>(r), image, seen, passed);
    inside = true;
  }
  if (inside) return seen;
  return std::vector<bool>(scene.rooms.size(), true);  // in a doorway: draw everything
}

}  // namespace vsgraphs
