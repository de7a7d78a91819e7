// Internal to core/simulate: which face each pixel sees. Faces are flat, so the inverse depth of each is an exact linear
// function of the pixel (homogeneous rasterisation without subdivision), and a z-buffer over it decides.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <limits>
#include <vector>

#include "core/geometry/camera.h"
#include "core/geometry/se3.h"
#include "simulate/scene.h"

namespace vsgraphs {

// One exposure of the pinhole: pixel (u, v) looks along the ray through (u + offset_u, v + offset_v).
struct View {
  const Camera* camera = nullptr;
  Se3 camera_from_world;
  double offset_u = 0, offset_v = 0;
  double time_s = 0;                                             // where moving things are
  int row_begin = 0, row_end = std::numeric_limits<int>::max();  // only these rows are wanted
};

// Linear function of the pixel: a u + b v + c.
template <typename T>
struct PixelForm {
  T a = 0, b = 0, c = 0;
  T at(T u, T v) const { return a * u + b * v + c; }
};

// A face's plane in the camera and what shading needs of it.
struct FaceView {
  PixelForm<double> inverse_depth;
  PixelForm<double> s_over_z, t_over_z;  // of (s + s_shift), (t + t_shift)
  double s_shift = 0, t_shift = 0;
};

// Where a face is at one moment, in the world; what a mirror shows lies behind it, the wrong way round.
struct Placement {
  Eigen::Vector3d origin, s_axis, t_axis, normal;
  static Placement of(const Face& face) { return {face.origin, face.s_axis, face.t_axis, face.normal()}; }
  Placement moved(const Se3& world_from_mover) const;
  Placement reflected(const Placement& mirror) const;
};

FaceView face_view(const Placement& place, const View& view);

class VisibilityBuffer {
 public:
  VisibilityBuffer(int width, int height);

  // Draws the faces of the rooms in `rooms` (indexed by room) and those of no room, in the view's rows. About 2 ms at
  // 640x480; each mirror in sight costs as much again.
  void draw(const Scene& scene, const View& view, const std::vector<bool>& rooms);

  int width() const { return width_; }
  int height() const { return height_; }
  // What is seen, -1 for nothing: a face i, or face i in mirror k as i + (k + 1) * faces. Valid after draw().
  const std::int32_t* face_row(int v) const {
    return faces_.data() + static_cast<std::ptrdiff_t>(v) * width_;
  }
  const float* inverse_depth_row(int v) const {
    return inverse_depths_.data() + static_cast<std::ptrdiff_t>(v) * width_;
  }
  // The pane of glass before what is seen, as a face; -1 for none. nullptr in scenes without glass.
  const std::int32_t* pane_row(int v) const {
    return panes_.empty() ? nullptr : panes_.data() + static_cast<std::ptrdiff_t>(v) * width_;
  }
  // Views of what was drawn, indexed as in face_row(); others hold old values.
  const std::vector<FaceView>& views() const { return views_; }

 private:
  struct Edge {
    double v_min, v_max, u_at_v_min, slope;
  };
  struct Rows {
    int begin, end;
  };
  // A ball around a face that does not move, and where it faces.
  struct Ball {
    Eigen::Vector3d centre, normal;
    double radius = 0;
  };
  void measure(const Scene& scene);
  void look(const Scene& scene, const View& view);
  void clear(const Scene& scene);
  Placement placed(const Face& face) const;
  bool facing(const Face& face, const Placement& place) const;
  // False where a face surely covers no pixel of the rows wanted.
  bool within_sight(const Face& face, const Ball& ball) const;
  void draw_mirrors(const Scene& scene, const View& view);
  void draw_behind(const Scene& scene, const View& view, std::size_t k);
  void draw_panes(const Scene& scene, const View& view, const std::vector<bool>& rooms);
  bool project(const Face& face, const Placement& place, const View& view);
  void add_contour(const Polygon2& contour, const Placement& place, const View& view);
  // Calls paint(v, first, last, inverse depth at u = 0, its step) for each run of pixels of the face at hand.
  template <typename Paint>
  void each_run(const FaceView& face_view, const Paint& paint);
  void fill(std::int32_t index, const FaceView& face_view);

  int width_, height_;
  Rows rows_{};  // of the view at hand
  Eigen::Vector3d eye_, axis_;
  std::array<Eigen::Vector3d, 4> sides_;  // normals of what is in sight, inwards: left, right, top, bottom
  const Scene* measured_ = nullptr;       // whose balls these are
  std::vector<Ball> balls_;
  std::vector<bool> drawn_;  // mirrors with a pixel in these rows
  std::vector<Se3> movers_;  // in the world, at the view's time
  std::vector<float> inverse_depths_;
  std::vector<std::int32_t> faces_;
  std::vector<std::uint8_t> in_mirror_;  // 0, or the mirror's number + 1
  std::vector<std::int32_t> panes_;
  std::vector<FaceView> views_;
  std::vector<Edge> edges_;               // of the face at hand
  std::vector<Eigen::Vector3d> clipped_;  // contour at hand, in the camera
  std::vector<double> crossings_;         // of the row at hand
  double bounds_[4]{};                    // u_min, u_max, v_min, v_max of the face at hand
};

// Rooms that can be seen from a camera: its own and, through the doorways in view, their neighbours.
std::vector<bool> visible_rooms(const Scene& scene, const View& view);

}  // namespace vsgraphs
