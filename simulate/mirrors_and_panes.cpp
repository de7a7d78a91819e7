// What is seen in mirrors and through glass.
#include "simulate/visibility_runs.h"

namespace vsgraphs {

void VisibilityBuffer::draw_mirrors(const Scene& scene, const View& view) {
  for (std::size_t k = 0; k < scene.mirrors.size(); ++k) {
    const std::int32_t mirror = scene.mirrors[k];
    if (!drawn_[static_cast<std::size_t>(mirror)]) continue;
    bool seen = false;
    for (std::size_t i = static_cast<std::size_t>(rows_.begin) * width_;
         i < static_cast<std::size_t>(rows_.end) * width_; ++i) {
      if (faces_[i] != mirror) continue;
      in_mirror_[i] = static_cast<std::uint8_t>(k + 1);
      inverse_depths_[i] = 0;
      seen = true;
    }
    if (seen) draw_behind(scene, view, k);
  }
}

void VisibilityBuffer::draw_behind(const Scene& scene, const View& view, std::size_t k) {
  const auto mirror = static_cast<std::size_t>(scene.mirrors[k]);
  const Placement glass = placed(scene.faces[mirror]);
  const PixelForm<double> front = views_[mirror].inverse_depth;
  for (std::size_t i = 0; i < scene.faces.size(); ++i) {
    const Face& face = scene.faces[i];
    if (i == mirror || face.optics == Optics::glass) continue;
    const Placement place = placed(face).reflected(glass);
    if (!facing(face, place) || !project(face, place, view)) continue;
    const std::size_t index = i + (k + 1) * scene.faces.size();
    views_[index] = face_view(place, view);
    each_run(views_[index], [&](int v, int u0, int u1, float start, float step) {
      const std::ptrdiff_t row = static_cast<std::ptrdiff_t>(v) * width_;
      for (int u = u0; u <= u1; ++u) {
        if (in_mirror_[static_cast<std::size_t>(row + u)] != k + 1) continue;
        const auto p = static_cast<std::size_t>(row + u);
        const float z = start + step * static_cast<float>(u);
        // What stands behind the mirror would be reflected to before it.
        if (z <= inverse_depths_[p] || z >= static_cast<float>(front.at(u, v))) continue;
        inverse_depths_[p] = z, faces_[p] = static_cast<std::int32_t>(index);
      }
    });
  }
  for (std::size_t p = static_cast<std::size_t>(rows_.begin) * width_;
       p < static_cast<std::size_t>(rows_.end) * width_; ++p) {
    if (in_mirror_[p] != k + 1 || inverse_depths_[p] > 0)
      continue;  // nothing to be seen in it: the pane itself
    const auto w = static_cast<std::size_t>(width_);
    inverse_depths_[p] = static_cast<float>(front.at(static_cast<double>(p % w), static_cast<double>(p / w)));
  }
}

void VisibilityBuffer::draw_panes(const Scene& scene, const View& view, const std::vector<bool>& rooms) {
  for (const int i : scene.panes) {
    const Face& face = scene.faces[static_cast<std::size_t>(i)];
    if (face.room >= 0 && !rooms[static_cast<std::size_t>(face.room)]) continue;
    if (!within_sight(face, balls_[static_cast<std::size_t>(i)])) continue;
    const Placement place = placed(face);
    if (!facing(face, place) || !project(face, place, view)) continue;
    FaceView& pane = views_[static_cast<std::size_t>(i)] = face_view(place, view);
    each_run(pane, [&](int v, int u0, int u1, float start, float step) {
      const std::ptrdiff_t row = static_cast<std::ptrdiff_t>(v) * width_;
      for (int u = u0; u <= u1; ++u) {
        const auto p = static_cast<std::size_t>(row + u);
        const float z = start + step * static_cast<float>(u);
        if (z <= inverse_depths_[p]) continue;
        std::int32_t& first = panes_[p];
        if (first < 0 || z > views_[static_cast<std::size_t>(first)].inverse_depth.at(u, v)) first = i;
      }
    });
  }
}

}  // namespace vsgraphs
