// Internal to core/simulate: which face each pixel sees. Faces are flat, so the inverse depth of each is an exact linear
// function of the pixel (homogeneous rasterisation without subdivision), and a z-buffer over it decides.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "core/geometry/camera.h"
#include "core/geometry/se3.h"
#include "core/simulate/scene.h"

namespace vsgraphs {

// One exposure of the pinhole: pixel (u, v) looks along the ray through (u + offset_u, v + offset_v).
struct View {
  const Camera* camera = nullptr;
  Se3 camera_from_world;
  double offset_u = 0, offset_v = 0;
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

FaceView face_view(const Face& face, const View& view);

class VisibilityBuffer {
 public:
  VisibilityBuffer(int width, int height);

  // Draws the faces of the rooms in `rooms` (indexed by room) and those of no room. About 2 ms at 640x480.
  void draw(const Scene& scene, const View& view, const std::vector<bool>& rooms);

  int width() const { return width_; }
  int height() const { return height_; }
  // Index of the face seen, -1 for none; valid after draw().
  const std::int32_t* face_row(int v) const {
    return faces_.data() + static_cast<std::ptrdiff_t>(v) * width_;
  }
  const float* inverse_depth_row(int v) const {
    return inverse_depths_.data() + static_cast<std::ptrdiff_t>(v) * width_;
  }
  // Views of the faces drawn, indexed by face; others hold old values.
  const std::vector<FaceView>& views() const { return views_; }

 private:
  struct Edge {
    double v_min, v_max, u_at_v_min, slope;
  };
  bool project(const Face& face, const View& view);
  void add_contour(const Polygon2& contour, const Face& face, const View& view);
  void fill(std::int32_t index, const FaceView& face_view);

  int width_, height_;
  std::vector<float> inverse_depths_;
  std::vector<std::int32_t> faces_;
  std::vector<FaceView> views_;
  std::vector<Edge> edges_;               // of the face at hand
  std::vector<Eigen::Vector3d> clipped_;  // contour at hand, in the camera
  std::vector<double> crossings_;         // of the row at hand
  double bounds_[4]{};                    // u_min, u_max, v_min, v_max of the face at hand
};

// Rooms that can be seen from a camera: its own and, through the doorways in view, their neighbours.
std::vector<bool> visible_rooms(const Scene& scene, const View& view);

}  // namespace vsgraphs
