#include "simulate/renderer.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/base/check.h"
#include "simulate/sensor_noise.h"
#include "simulate/shading.h"

namespace vsgraphs {
namespace {

constexpr double band_s = 0.001;  // of a rolling shutter: rows within it share a moment
constexpr double still_px = 3.5;  // motion during an exposure that two rays show well enough
constexpr float pane_passes = 0.88f, pane_adds = 7.0f;  // light through a pane of glass, and off it

// A row's pixels first..end that see one face straight on: what the general case below works out, in loops without
// branches.
void read_run(const Camera& camera, const PixelForm<double>& form, int v, int first, int end,
              ExactDepth& out) {
  std::uint16_t* depth = &out.depth.at(0, v);
  for (int u = first; u < end; ++u) {
    const double raw = camera.depth_scale / form.at(u, v) + 0.5;
    depth[u] = static_cast<std::uint16_t>(raw < 65536 && raw >= 0 ? static_cast<std::int32_t>(raw) : 0);
  }
  if (out.incidence.empty()) return;
  float* incidence = &out.incidence.at(0, v);
  const double nx = form.a * camera.fx, ny = form.b * camera.fy;
  const double nz = form.c + form.a * camera.cx + form.b * camera.cy;
  const double n2 = nx * nx + ny * ny + nz * nz, y = (v - camera.cy) / camera.fy;
  for (int u = first; u < end; ++u) {
    const double x = (u - camera.cx) / camera.fx;
    incidence[u] = static_cast<float>(std::abs(form.at(u, v)) / std::sqrt(n2 * (x * x + y * y + 1)));
  }
}

std::vector<LensMap> lens_map(const Camera& camera, const Lens& lens) {
  if (!lens.bends()) return {};
  std::vector<Eigen::Vector2d> offsets{{0, 0}};
  for (const Ray& ray : rays) offsets.emplace_back(ray.offset_u, ray.offset_v);
  return {LensMap(camera, lens, offsets)};
}

}  // namespace

Renderer::Renderer(const Scene& scene, const Camera& camera, const NoiseOptions& noise)
    : scene_(scene),
      camera_(camera),
      noise_(noise),
      lens_(lens_map(camera, noise.lens)),
      buffer_(pinhole().width, pinhole().height),
      meter_(meter_of(camera)),
      meter_buffer_(meter_.width, meter_.height),
      colour_(3 * static_cast<std::size_t>(camera.width) * camera.height),
      ray_(3 * static_cast<std::size_t>(camera.width)) {
  camera.validate();
  noise.validate();
  require_input(!camera.distorted(), "camera: give the lens as an effect of the camera, not as k1..k3");
  if (noise.roll_deg != 0)
    mount_ = Se3(so3_exp({0, 0, noise.roll_deg * std::numbers::pi / 180}), Eigen::Vector3d::Zero());
}

View Renderer::view_at(const Moment& moment) const {
  Se3 world_from_camera =
      noise_.roll_deg == 0 ? scene_.path.world_from_camera(moment.time_s) : camera_at(moment.time_s);
  if (moment.right_m != 0)
    world_from_camera = world_from_camera * Se3(so3_exp({0, 0, 0}), {moment.right_m, 0, 0});
  return {&pinhole(), world_from_camera.inverse(), moment.offset_u, moment.offset_v, moment.time_s};
}

// Calls look(begin, end, seconds after the middle row) for the rows that are taken at one moment.
template <typename Look>
void Renderer::each_band(bool rolling, const Look& look) const {
  const int height = camera_.height;
  if (!rolling || noise_.rolling_shutter_s <= 0) return look(0, height, 0.0);
  const int band_rows = std::max(1, static_cast<int>(band_s * height / noise_.rolling_shutter_s));
  for (int begin = 0; begin < height; begin += band_rows) {
    const int end = std::min(begin + band_rows, height);
    const double middle = 0.5 * (begin + end - 1) / std::max(1, height - 1);
    look(begin, end, noise_.rolling_shutter_s * (middle - 0.5));
  }
}

// Draws what rows begin..end of the image look at.
void Renderer::draw_rows(const Moment& moment, int begin, int end) {
  View view = view_at(moment);
  const std::array<int, 2> rows = lens_.empty() ? std::array{begin, end} : lens_.front().rows(begin, end);
  view.row_begin = rows[0], view.row_end = rows[1];
  buffer_.draw(scene_, view, visible_rooms(scene_, view));
}

void Renderer::look_at_geometry(const Moment& moment, ExactDepth& out, Image<std::uint16_t>* instance) {
  out.label = Image<std::uint8_t>(camera_.width, camera_.height);
  each_band(moment.rolling, [&](int begin, int end, double later) {
    Moment now = moment;
    now.time_s += later;
    draw_rows(now, begin, end);
    for (int v = begin; v < end; ++v) look_at_row(v, out, instance);
  });
}

void Renderer::look_at_depth(ExactDepth& out, const Moment& moment, Image<std::uint16_t>* instance) {
  const int w = camera_.width, h = camera_.height;
  out.depth = Image<std::uint16_t>(w, h);
  if (noise_.depth_holes) out.incidence = Image<float>(w, h);
  if (!scene_.panes.empty()) out.pane = Image<std::uint16_t>(w, h), out.pane_incidence = Image<float>(w, h);
  look_at_geometry(moment, out, instance);
}

void Renderer::look_at_row(int v, ExactDepth& out, Image<std::uint16_t>* instance) const {
  for (int u = 0; u < camera_.width; ++u) {
    const int end = lens_.empty() ? look_at_run(u, v, out, instance) : u;
    if (end == u)
      look_at_pixel(u, v, out, instance);
    else
      u = end - 1;
  }
}

// Pixels from `first` on that see one face, straight and through no glass. Returns where they end: `first` where there are none.
int Renderer::look_at_run(int first, int v, ExactDepth& out, Image<std::uint16_t>* instance) const {
  const std::int32_t *row = buffer_.face_row(v), *panes = buffer_.pane_row(v);
  const std::int32_t seen = row[first];
  if (seen < 0 || seen >= static_cast<std::int32_t>(scene_.faces.size())) return first;
  int end = first;
  while (end < camera_.width && row[end] == seen && (panes == nullptr || panes[end] < 0)) ++end;
  if (end == first) return first;
  const auto i = static_cast<std::size_t>(seen);
  if (!out.depth.empty()) read_run(camera_, buffer_.views()[i].inverse_depth, v, first, end, out);
  std::fill(&out.label.at(first, v), &out.label.at(end - 1, v) + 1,
            static_cast<std::uint8_t>(scene_.faces[i].label));
  if (instance != nullptr)
    std::fill(&instance->at(first, v), &instance->at(end - 1, v) + 1, scene_.faces[i].instance);
  return end;
}

void Renderer::look_at_pixel(int u, int v, ExactDepth& out, Image<std::uint16_t>* instance) const {
  const auto units = [&](double inverse_depth) {
    const double raw = camera_.depth_scale / inverse_depth + 0.5;
    return raw < 65536 && raw >= 0 ? static_cast<std::uint16_t>(raw) : std::uint16_t{0};
  };
  const Eigen::Vector2d at =
      lens_.empty() ? Eigen::Vector2d(u, v) : Eigen::Vector2d(lens_.front().at(0, u, v).cast<double>());
  const int x = static_cast<int>(at.x() + 0.5), y = static_cast<int>(at.y() + 0.5);
  const std::int32_t seen = buffer_.face_row(y)[x];
  if (seen < 0) return;
  const auto i = static_cast<std::size_t>(seen);
  const Face* face = &scene_.faces[i % scene_.faces.size()];
  const auto read = [&](std::size_t index, Image<std::uint16_t>& depth, Image<float>& incidence) {
    if (depth.empty()) return;
    const PixelForm<double>& form = buffer_.views()[index].inverse_depth;
    const double inverse_depth = form.at(at.x(), at.y());
    depth.at(u, v) = units(inverse_depth);
    if (!incidence.empty())
      incidence.at(u, v) = incidence_cosine(pinhole(), form, inverse_depth, at.x(), at.y());
  };
  read(i, out.depth, out.incidence);
  const std::int32_t* panes = buffer_.pane_row(y);
  if (panes != nullptr && panes[x] >= 0) {
    const auto p = static_cast<std::size_t>(panes[x]);
    face = &scene_.faces[p];
    read(p, out.pane, out.pane_incidence);
  } else if (i >= scene_.faces.size()) {
    face = &scene_.faces[static_cast<std::size_t>(scene_.mirrors[i / scene_.faces.size() - 1])];
  }
  out.label.at(u, v) = static_cast<std::uint8_t>(face->label);
  if (instance != nullptr) instance->at(u, v) = face->instance;
}

void Renderer::cut_border(Image<std::uint16_t>& depth) const {
  const int right = static_cast<int>(noise_.border_right * depth.width),
            top = static_cast<int>(noise_.border_top * depth.height);
  for (int v = 0; v < depth.height; ++v)
    std::fill_n(&depth.at(0, v) + (v < top ? 0 : depth.width - right), v < top ? depth.width : right,
                std::uint16_t{0});
}

void Renderer::shade(int sample, int begin, int end) {
  const auto row_of = [&](float* first) {
    return ColourRow{first, first + camera_.width, first + 2 * static_cast<std::ptrdiff_t>(camera_.width)};
  };
  for (int v = begin; v < end; ++v) {
    float* colour = colour_.data() + 3 * static_cast<std::ptrdiff_t>(v) * camera_.width;
    const std::int32_t* panes = lens_.empty() ? buffer_.pane_row(v) : nullptr;
    const bool clear =
        panes != nullptr && std::all_of(panes, panes + camera_.width, [](std::int32_t p) { return p < 0; });
    if (scene_.panes.empty() || clear) {
      shade_row(v, sample, row_of(colour));
      continue;
    }
    std::fill(ray_.begin(), ray_.end(), 0.0f);
    shade_row(v, sample, row_of(ray_.data()));
    tint_row(v, sample, row_of(ray_.data()));
    for (std::size_t i = 0; i < ray_.size(); ++i) colour[i] += ray_[i];
  }
}

void Renderer::shade_row(int v, int sample, const ColourRow& colour) {
  if (!lens_.empty()) return shade_bent_row(v, sample, colour);
  const std::int32_t* faces = buffer_.face_row(v);
  for (int u = 0; u < camera_.width;) {
    const std::int32_t id = faces[u];
    int end = u + 1;
    while (end < camera_.width && faces[end] == id) ++end;
    if (id >= 0) {
      const auto i = static_cast<std::size_t>(id);
      const Face& face = scene_.faces[i % scene_.faces.size()];
      const Shader shader(face, buffer_.views()[i],
                          scene_.materials[static_cast<std::size_t>(face.material)]);
      shade_run(shader, buffer_.inverse_depth_row(v), u, end, v, sample, colour);
    }
    u = end;
  }
}

void Renderer::shade_bent_row(int v, int sample, const ColourRow& colour) {
  const auto offset = static_cast<std::size_t>(sample) + 1;
  const auto seen = [&](const Eigen::Vector2f& p) {
    return buffer_.face_row(static_cast<int>(p.y() + 0.5f))[static_cast<int>(p.x() + 0.5f)];
  };
  for (int u = 0; u < camera_.width;) {
    const std::int32_t id = seen(lens_.front().at(offset, u, v));
    const auto i = static_cast<std::size_t>(std::max(0, id));
    const Face& face = scene_.faces[i % scene_.faces.size()];
    const Shader shader(face, buffer_.views()[i], scene_.materials[static_cast<std::size_t>(face.material)]);
    for (; u < camera_.width; ++u) {
      const Eigen::Vector2f p = lens_.front().at(offset, u, v);
      if (seen(p) != id) break;
      if (id < 0) continue;
      const Colour c = shade_point(shader, p.x(), p.y(), sample);
      colour.r[u] += c.r, colour.g[u] += c.g, colour.b[u] += c.b;
    }
  }
}

void Renderer::tint_row(int v, int sample, const ColourRow& colour) const {
  for (int u = 0; u < camera_.width; ++u) {
    int x = u, y = v;
    if (!lens_.empty()) {
      const Eigen::Vector2f p = lens_.front().at(static_cast<std::size_t>(sample) + 1, u, v);
      x = static_cast<int>(p.x() + 0.5f), y = static_cast<int>(p.y() + 0.5f);
    }
    if (buffer_.pane_row(y)[x] < 0) continue;
    for (float* c : {colour.r, colour.g, colour.b}) c[u] = pane_passes * c[u] + pane_adds;
  }
}

// Of sensors whose optics are soft; the path of the image's middle at 1 m says how much is blurred.
bool Renderer::two_rays_do(const Exposure& exposure, double time_s) const {
  if (noise_.softness_px <= 0) return false;
  const Se3 moved =
      camera_at(time_s - 0.5 * exposure.time_s).inverse() * camera_at(time_s + 0.5 * exposure.time_s);
  return camera_.fx * (so3_log(moved.rotation()).norm() + moved.translation().norm()) < still_px;
}

void Renderer::render_colour(RenderedFrame& frame, int index) {
  std::fill(colour_.begin(), colour_.end(), 0.0f);
  const Exposure exposure = exposure_at(frame.time_s);
  const bool two = two_rays_do(exposure, frame.time_s);
  const int count = two ? 2 : rays_per_pixel, first = two ? first_of_two : 0;
  each_band(true, [&](int begin, int end, double later) {
    for (int k = 0; k < count; ++k) {
      const double time = frame.time_s + exposure.time_s * ((k + 0.5) / count - 0.5) + later;
      const Ray& ray = rays[first + k];
      const bool bent = !lens_.empty();  // then rays are picked from one image
      if (!bent || k == 0 || exposure.time_s > 0)
        draw_rows({time, bent ? 0 : ray.offset_u, bent ? 0 : ray.offset_v}, begin, end);
      shade(first + k, begin, end);
    }
  });
  NoiseOptions noise = noise_;
  noise.image_sigma = exposure.sigma;
  develop(noise, index, exposure.gain / static_cast<float>(count), colour_, frame.rgb);
}

Se3 Renderer::pose(int index) const {
  const double time_s = index / scene_.plan.fps;
  return noise_.roll_deg == 0 ? scene_.path.world_from_camera(time_s) : camera_at(time_s);
}

RenderedFrame Renderer::render(int index) {
  require_input(index >= 0 && index < frame_count(),
                "frame " + std::to_string(index) + " lies outside 0.." + std::to_string(frame_count() - 1));
  RenderedFrame frame;
  frame.time_s = index / scene_.plan.fps;
  frame.world_from_camera = pose(index);
  frame.rgb = Image<Rgb>(camera_.width, camera_.height);
  frame.instance = Image<std::uint16_t>(camera_.width, camera_.height);
  render_colour(frame, index);
  ExactDepth seen;
  const Moment now{frame.time_s, 0, 0, true};
  if (noise_.depth_apart()) {
    look_at_geometry(now, seen, &frame.instance);
    frame.label = std::move(seen.label);
    look_at_depth(seen,
                  {frame.time_s + noise_.depth_delay_s, noise_.misregistration_u_px,
                   noise_.misregistration_v_px, false, noise_.misregistration_baseline_m},
                  nullptr);
  } else {
    look_at_depth(seen, now, &frame.instance);
    frame.label = seen.label;
  }
  seen.colour = &frame.rgb;
  frame.depth = noise_.depth_holes || noise_.depth_quantisation ? sense(noise_, camera_, index, seen)
                                                                : std::move(seen.depth);
  if (noise_.depth_holes) cut_border(frame.depth);
  return frame;
}

}  // namespace vsgraphs
