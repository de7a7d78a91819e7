#include "simulate/visibility.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "simulate/visibility_runs.h"

namespace vsgraphs {
namespace {

constexpr double near_m = 0.02;

}  // namespace

Placement Placement::moved(const Se3& world_from_mover) const {
  const Eigen::Matrix3d& r = world_from_mover.rotation();
  return {world_from_mover * origin, r * s_axis, r * t_axis, r * normal};
}

Placement Placement::reflected(const Placement& mirror) const {
  const Eigen::Vector3d& n = mirror.normal;
  const auto turned = [&](const Eigen::Vector3d& d) -> Eigen::Vector3d { return d - 2 * n.dot(d) * n; };
  return {mirror.origin + turned(origin - mirror.origin), turned(s_axis), turned(t_axis), turned(normal)};
}

FaceView face_view(const Placement& place, const View& view) {
  const Camera& k = *view.camera;
  const Eigen::Matrix3d& r = view.camera_from_world.rotation();
  const Eigen::Vector3d origin = view.camera_from_world * place.origin;
  const auto form = [&](const Eigen::Vector3d& g) {
    // g . ((u + offset_u - cx) / fx, (v + offset_v - cy) / fy, 1)
    const double a = g.x() / k.fx, b = g.y() / k.fy;
    return PixelForm<double>{a, b, g.z() + a * (view.offset_u - k.cx) + b * (view.offset_v - k.cy)};
  };
  const Eigen::Vector3d s = r * place.s_axis, t = r * place.t_axis, n = s.cross(t);
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

void VisibilityBuffer::add_contour(const Polygon2& contour, const Placement& place, const View& view) {
  const Camera& k = *view.camera;
  const Eigen::Matrix3d& r = view.camera_from_world.rotation();
  const Eigen::Vector3d o = view.camera_from_world * place.origin, s = r * place.s_axis, t = r * place.t_axis;
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
    if (q.y() <= rows_.begin || p.y() > rows_.end - 1) continue;  // crosses no row
    edges_.push_back({p.y(), q.y(), p.x(), (q.x() - p.x()) / std::max(q.y() - p.y(), 1e-300)});
  }
}

bool VisibilityBuffer::project(const Face& face, const Placement& place, const View& view) {
  edges_.clear();
  constexpr double far = std::numeric_limits<double>::max();
  bounds_[0] = bounds_[2] = far;
  bounds_[1] = bounds_[3] = -far;
  for (const Polygon2& contour : face.contours) add_contour(contour, place, view);
  return !edges_.empty() && bounds_[0] < width_ && bounds_[1] > -1 && bounds_[2] < rows_.end &&
         bounds_[3] > rows_.begin - 1;
}

void VisibilityBuffer::fill(std::int32_t index, const FaceView& face_view) {
  each_run(face_view, [&](int v, int u0, int u1, float start, float step) {
    float* depth = inverse_depths_.data() + static_cast<std::ptrdiff_t>(v) * width_;
    std::int32_t* face = faces_.data() + static_cast<std::ptrdiff_t>(v) * width_;
    for (int u = u0; u <= u1; ++u) {
      const float z = start + step * static_cast<float>(u);
      const bool nearer = z > depth[u];
      depth[u] = nearer ? z : depth[u];
      face[u] = nearer ? index : face[u];
    }
  });
}

void VisibilityBuffer::clear(const Scene& scene) {
  const auto begin = static_cast<std::ptrdiff_t>(rows_.begin) * width_,
             end = static_cast<std::ptrdiff_t>(rows_.end) * width_;
  std::fill(inverse_depths_.begin() + begin, inverse_depths_.begin() + end, 0.0f);
  std::fill(faces_.begin() + begin, faces_.begin() + end, -1);
  views_.resize(scene.faces.size() * (scene.mirrors.size() + 1));
  if (!scene.mirrors.empty()) {
    drawn_.assign(scene.faces.size(), false);
    in_mirror_.resize(faces_.size());
    std::fill(in_mirror_.begin() + begin, in_mirror_.begin() + end, std::uint8_t{0});
  }
  if (!scene.panes.empty()) {
    panes_.resize(faces_.size());
    std::fill(panes_.begin() + begin, panes_.begin() + end, -1);
  }
}

Placement VisibilityBuffer::placed(const Face& face) const {
  const Placement place = Placement::of(face);
  return face.mover < 0 ? place : place.moved(movers_[static_cast<std::size_t>(face.mover)]);
}

bool VisibilityBuffer::facing(const Face& face, const Placement& place) const {
  const Eigen::Vector3d to = place.origin - eye_;
  return place.normal.dot(to) < -1e-9 &&     // not seen from behind
         axis_.dot(to) >= -face.size.sum();  // not wholly behind the camera
}

void VisibilityBuffer::measure(const Scene& scene) {
  if (measured_ == &scene && balls_.size() == scene.faces.size()) return;
  measured_ = &scene;
  balls_.clear();
  for (const Face& face : scene.faces) {
    const Eigen::Vector2d half = 0.5 * face.size;
    balls_.push_back(
        {face.origin + half.x() * face.s_axis + half.y() * face.t_axis, face.normal(), half.norm() + 1e-6});
  }
}

void VisibilityBuffer::look(const Scene& scene, const View& view) {
  const Camera& k = *view.camera;
  const Se3 world_from_camera = view.camera_from_world.inverse();
  eye_ = world_from_camera.translation();
  axis_ = view.camera_from_world.rotation().row(2);
  constexpr double margin_px = 1.5;
  const double left = (view.offset_u - k.cx - margin_px) / k.fx,
               right = (width_ - 1 + view.offset_u - k.cx + margin_px) / k.fx,
               top = (rows_.begin + view.offset_v - k.cy - margin_px) / k.fy,
               bottom = (rows_.end - 1 + view.offset_v - k.cy + margin_px) / k.fy;
  sides_ = {Eigen::Vector3d(1, 0, -left), Eigen::Vector3d(-1, 0, right), Eigen::Vector3d(0, 1, -top),
            Eigen::Vector3d(0, -1, bottom)};
  for (Eigen::Vector3d& side : sides_) side = world_from_camera.rotation() * side.normalized();
  movers_.clear();
  for (std::size_t m = 0; m < scene.movers.size(); ++m)
    movers_.push_back(scene.world_from_mover(static_cast<int>(m), view.time_s));
}

bool VisibilityBuffer::within_sight(const Face& face, const Ball& ball) const {
  if (face.mover >= 0) return true;
  const Eigen::Vector3d to = ball.centre - eye_;
  if (ball.normal.dot(face.origin - eye_) >= -1e-9) return false;  // seen from behind
  return std::all_of(sides_.begin(), sides_.end(),
                     [&](const Eigen::Vector3d& side) { return side.dot(to) >= -ball.radius; });
}

void VisibilityBuffer::draw(const Scene& scene, const View& view, const std::vector<bool>& rooms) {
  rows_ = {std::max(0, view.row_begin), std::min(height_, view.row_end)};
  if (rows_.begin >= rows_.end) return;
  measure(scene);
  clear(scene);
  look(scene, view);
  for (std::size_t i = 0; i < scene.faces.size(); ++i) {
    const Face& face = scene.faces[i];
    if (face.optics == Optics::glass || !within_sight(face, balls_[i])) continue;
    if (face.room >= 0 && !rooms[static_cast<std::size_t>(face.room)]) continue;
    const Placement place = placed(face);
    if (!facing(face, place) || !project(face, place, view)) continue;
    views_[i] = face_view(place, view);
    fill(static_cast<std::int32_t>(i), views_[i]);
    if (face.optics == Optics::mirror) drawn_[i] = true;
  }
  if (!scene.mirrors.empty()) draw_mirrors(scene, view);
  if (!scene.panes.empty()) draw_panes(scene, view, rooms);
}

}  // namespace vsgraphs
