#include "core/simulate/renderer.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "core/base/check.h"
#include "core/simulate/sensor_noise.h"

namespace vsgraphs {
namespace {

constexpr int rays_per_pixel = 4;
// Offsets within the pixel (a rotated grid) and fractions of a texture level: four rays together filter in both.
constexpr double ray_offsets[rays_per_pixel][2] = {
    {-0.125, -0.375}, {0.375, -0.125}, {-0.375, 0.125}, {0.125, 0.375}};
constexpr float level_offsets[rays_per_pixel] = {0.0f, 0.5f, 0.25f, 0.75f};
constexpr float level_bias = -0.9f;  // four rays resolve about one level more than one does
constexpr int chunk_px = 8;          // level and light are worked out once per chunk of a row

// log2 good to a tenth, from the float's exponent and the top of its mantissa.
float fast_log2(float x) {
  const auto bits = std::bit_cast<std::int32_t>(x);
  return static_cast<float>(bits - 0x3f800000) * (1.0f / 8388608.0f);
}

float light_at(const Lightmap& map, float s, float t) {
  const float x = std::clamp(s * map.nodes_per_s, 0.0f, static_cast<float>(map.width) - 1.001f);
  const float y = std::clamp(t * map.nodes_per_t, 0.0f, static_cast<float>(map.height) - 1.001f);
  const int i = static_cast<int>(x), j = static_cast<int>(y);
  const float fx = x - static_cast<float>(i), fy = y - static_cast<float>(j);
  const float* a = map.light.data() + static_cast<std::ptrdiff_t>(j) * map.width + i;
  const float* b = a + map.width;
  return (1 - fy) * ((1 - fx) * a[0] + fx * a[1]) + fy * ((1 - fx) * b[0] + fx * b[1]);
}

// Everything one face needs per pixel, in single precision.
struct Shader {
  PixelForm<float> s, t;
  float s_shift, t_shift;
  float s_scale, t_scale, s_offset, t_offset;  // metres to repeats
  float iz_a, iz_b;
  const Face* face;
  const Texture* texture;

  Shader(const Face& f, const FaceView& view, const MaterialStore::Entry& material)
      : face(&f), texture(&material.texture) {
    const auto narrow = [](const PixelForm<double>& p) {
      return PixelForm<float>{static_cast<float>(p.a), static_cast<float>(p.b), static_cast<float>(p.c)};
    };
    s = narrow(view.s_over_z), t = narrow(view.t_over_z);
    s_shift = static_cast<float>(view.s_shift), t_shift = static_cast<float>(view.t_shift);
    s_scale = static_cast<float>(f.repeats_per_m.x()), t_scale = static_cast<float>(f.repeats_per_m.y());
    s_offset = static_cast<float>(f.texture_offset.x()), t_offset = static_cast<float>(f.texture_offset.y());
    iz_a = static_cast<float>(view.inverse_depth.a), iz_b = static_cast<float>(view.inverse_depth.b);
  }

  // Texture level where a pixel covers about one texel; the geometric mean of both directions, so that floors seen at
  // a slant stay crisp along the way.
  int level(float u, float v, float z, float dither) const {
    const float su = s.at(u, v) * z, tu = t.at(u, v) * z;
    const float w = s_scale * static_cast<float>(texture->width()),
                h = t_scale * static_cast<float>(texture->height());
    const float dx0 = z * (s.a - iz_a * su) * w, dx1 = z * (t.a - iz_a * tu) * h;
    const float dy0 = z * (s.b - iz_b * su) * w, dy1 = z * (t.b - iz_b * tu) * h;
    const float area2 = (dx0 * dx0 + dx1 * dx1) * (dy0 * dy0 + dy1 * dy1);
    const float level = 0.25f * fast_log2(area2 + 1e-12f) + level_bias + dither;
    return std::clamp(static_cast<int>(std::floor(level)), 0, texture->level_count() - 1);
  }
};

void shade_run(const Shader& shader, const float* inverse_depth, int begin, int end, int v, int sample,
               float* colour) {
  const float y = static_cast<float>(v);
  const auto place = [&](int u, float z) {
    const float x = static_cast<float>(u);
    return std::pair{shader.s.at(x, y) * z - shader.s_shift, shader.t.at(x, y) * z - shader.t_shift};
  };
  for (int u0 = begin; u0 < end; u0 += chunk_px) {
    const int u1 = std::min(u0 + chunk_px, end);
    const int last = u1 - 1;
    const float z0 = 1 / inverse_depth[u0], z1 = 1 / inverse_depth[last];
    const int level = shader.level(static_cast<float>(u0), y, z0, level_offsets[sample]);
    const auto [s0, t0] = place(u0, z0);
    const auto [s1, t1] = place(last, z1);
    float light = light_at(shader.face->lightmap, s0, t0);
    const float step =
        last > u0 ? (light_at(shader.face->lightmap, s1, t1) - light) / static_cast<float>(last - u0) : 0.0f;
    for (int u = u0; u < u1; ++u) {
      const auto [s, t] = place(u, 1 / inverse_depth[u]);
      const Colour c = shader.texture->sample(s * shader.s_scale + shader.s_offset,
                                              t * shader.t_scale + shader.t_offset, level);
      colour[3 * u] += light * c.r;
      colour[3 * u + 1] += light * c.g;
      colour[3 * u + 2] += light * c.b;
      light += step;
    }
  }
}

}  // namespace

Renderer::Renderer(const Scene& scene, const Camera& camera, const NoiseOptions& noise)
    : scene_(scene),
      camera_(camera),
      noise_(noise),
      buffer_(camera.width, camera.height),
      colour_(3 * static_cast<std::size_t>(camera.width) * camera.height) {
  camera.validate();
  noise.validate();
  require_input(!camera.distorted(),
                "camera: the simulator renders a pinhole without distortion; leave k1..k3 out");
}

View Renderer::view_at(double time_s, double offset_u, double offset_v) const {
  return {&camera_, scene_.path.world_from_camera(time_s).inverse(), offset_u, offset_v};
}

void Renderer::render_geometry(RenderedFrame& frame, Image<float>& incidence) {
  const View view = view_at(frame.time_s, 0, 0);
  buffer_.draw(scene_, view, visible_rooms(scene_, view));
  const bool need_incidence = noise_.depth_holes;
  for (int v = 0; v < camera_.height; ++v) {
    const std::int32_t* faces = buffer_.face_row(v);
    for (int u = 0; u < camera_.width; ++u) {
      if (faces[u] < 0) continue;
      const auto i = static_cast<std::size_t>(faces[u]);
      const Face& face = scene_.faces[i];
      const PixelForm<double>& form = buffer_.views()[i].inverse_depth;
      const double inverse_depth = form.at(u, v);
      const double raw = camera_.depth_scale / inverse_depth + 0.5;
      frame.depth.at(u, v) = raw < 65536 ? static_cast<std::uint16_t>(raw) : std::uint16_t{0};
      frame.label.at(u, v) = static_cast<std::uint8_t>(face.label);
      frame.instance.at(u, v) = face.instance;
      if (need_incidence) incidence.at(u, v) = incidence_cosine(camera_, form, inverse_depth, u, v);
    }
  }
}

void Renderer::shade(int sample) {
  for (int v = 0; v < camera_.height; ++v) {
    const std::int32_t* faces = buffer_.face_row(v);
    float* colour = colour_.data() + 3 * static_cast<std::ptrdiff_t>(v) * camera_.width;
    for (int u = 0; u < camera_.width;) {
      const std::int32_t id = faces[u];
      int end = u + 1;
      while (end < camera_.width && faces[end] == id) ++end;
      if (id >= 0) {
        const Face& face = scene_.faces[static_cast<std::size_t>(id)];
        const Shader shader(face, buffer_.views()[static_cast<std::size_t>(id)],
                            scene_.materials[static_cast<std::size_t>(face.material)]);
        shade_run(shader, buffer_.inverse_depth_row(v), u, end, v, sample, colour);
      }
      u = end;
    }
  }
}

void Renderer::render_colour(RenderedFrame& frame, int index) {
  std::fill(colour_.begin(), colour_.end(), 0.0f);
  const double exposure = noise_.motion_blur ? noise_.exposure_time_s : 0.0;
  for (int k = 0; k < rays_per_pixel; ++k) {
    const double time = frame.time_s + exposure * ((k + 0.5) / rays_per_pixel - 0.5);
    const View view = view_at(time, ray_offsets[k][0], ray_offsets[k][1]);
    buffer_.draw(scene_, view, visible_rooms(scene_, view));
    shade(k);
  }
  const float gain = noise_.exposure ? exposure_gain(noise_, frame.time_s) : 1.0f;
  develop(noise_, index, gain / rays_per_pixel, colour_, frame.rgb);
}

RenderedFrame Renderer::render(int index) {
  require_input(index >= 0 && index < frame_count(),
                "frame " + std::to_string(index) + " lies outside 0.." + std::to_string(frame_count() - 1));
  RenderedFrame frame;
  frame.time_s = index / scene_.plan.fps;
  frame.world_from_camera = scene_.path.world_from_camera(frame.time_s);
  frame.rgb = Image<Rgb>(camera_.width, camera_.height);
  frame.depth = Image<std::uint16_t>(camera_.width, camera_.height);
  frame.label = Image<std::uint8_t>(camera_.width, camera_.height);
  frame.instance = Image<std::uint16_t>(camera_.width, camera_.height);
  Image<float> incidence(noise_.depth_holes ? camera_.width : 0, noise_.depth_holes ? camera_.height : 0);
  render_geometry(frame, incidence);
  if (noise_.depth_holes || noise_.depth_quantisation)
    frame.depth = sense_depth(noise_, camera_, index, frame.depth, frame.label, incidence);
  render_colour(frame, index);
  return frame;
}

}  // namespace vsgraphs
