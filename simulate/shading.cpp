#include "simulate/shading.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace vsgraphs {
namespace {

constexpr float level_bias = -0.9f;  // four rays resolve about one level more than one does
constexpr int chunk_px = 8;          // level and light are worked out once per chunk of a row

// log2 good to a tenth, from the float's exponent and the top of its mantissa.
float fast_log2(float x) {
  const auto bits = std::bit_cast<std::int32_t>(x);
  return static_cast<float>(bits - 0x3f800000) * (1.0f / 8388608.0f);
}

}  // namespace

float light_at(const Lightmap& map, float s, float t) {
  const float x = std::clamp(s * map.nodes_per_s, 0.0f, static_cast<float>(map.width) - 1.001f);
  const float y = std::clamp(t * map.nodes_per_t, 0.0f, static_cast<float>(map.height) - 1.001f);
  const int i = static_cast<int>(x), j = static_cast<int>(y);
  const float fx = x - static_cast<float>(i), fy = y - static_cast<float>(j);
  const float* a = map.light.data() + static_cast<std::ptrdiff_t>(j) * map.width + i;
  const float* b = a + map.width;
  return (1 - fy) * ((1 - fx) * a[0] + fx * a[1]) + fy * ((1 - fx) * b[0] + fx * b[1]);
}

Shader::Shader(const Face& f, const FaceView& view, const MaterialStore::Entry& material)
    : face(&f), texture(&material.texture) {
  const auto narrow = [](const PixelForm<double>& p) {
    return PixelForm<float>{static_cast<float>(p.a), static_cast<float>(p.b), static_cast<float>(p.c)};
  };
  inverse_depth = narrow(view.inverse_depth);
  s = narrow(view.s_over_z), t = narrow(view.t_over_z);
  s_shift = static_cast<float>(view.s_shift), t_shift = static_cast<float>(view.t_shift);
  s_scale = static_cast<float>(f.repeats_per_m.x()), t_scale = static_cast<float>(f.repeats_per_m.y());
  s_offset = static_cast<float>(f.texture_offset.x()), t_offset = static_cast<float>(f.texture_offset.y());
  iz_a = static_cast<float>(view.inverse_depth.a), iz_b = static_cast<float>(view.inverse_depth.b);
}

int Shader::level(float u, float v, float z, float dither) const {
  const float su = s.at(u, v) * z, tu = t.at(u, v) * z;
  const float w = s_scale * static_cast<float>(texture->width()),
              h = t_scale * static_cast<float>(texture->height());
  const float dx0 = z * (s.a - iz_a * su) * w, dx1 = z * (t.a - iz_a * tu) * h;
  const float dy0 = z * (s.b - iz_b * su) * w, dy1 = z * (t.b - iz_b * tu) * h;
  const float area2 = (dx0 * dx0 + dx1 * dx1) * (dy0 * dy0 + dy1 * dy1);
  const float level = 0.25f * fast_log2(area2 + 1e-12f) + level_bias + dither;
  return std::clamp(static_cast<int>(std::floor(level)), 0, texture->level_count() - 1);
}

// Eight pixels whose level and light's course are known; every step as it is done for one.
static void shade_batch(const Shader& shader, const float* inverse_depth, int u0, float y, int level,
                        float light, float light_step, const ColourRow& colour) {
  float s[Texture::batch], t[Texture::batch], lights[Texture::batch];
  for (int i = 0; i < Texture::batch; ++i) {
    const float x = static_cast<float>(u0 + i), z = 1 / inverse_depth[u0 + i];
    const float sm = shader.s.at(x, y) * z - shader.s_shift, tm = shader.t.at(x, y) * z - shader.t_shift;
    s[i] = sm * shader.s_scale + shader.s_offset;
    t[i] = tm * shader.t_scale + shader.t_offset;
  }
  for (float& l : lights) l = light, light += light_step;
  Texture::Batch c;
  shader.texture->sample_batch(s, t, level, c);
  float *r = colour.r + u0, *g = colour.g + u0, *b = colour.b + u0;
  for (int i = 0; i < Texture::batch; ++i) r[i] += lights[i] * c.r[i];
  for (int i = 0; i < Texture::batch; ++i) g[i] += lights[i] * c.g[i];
  for (int i = 0; i < Texture::batch; ++i) b[i] += lights[i] * c.b[i];
}

void shade_run(const Shader& shader, const float* inverse_depth, int begin, int end, int v, int sample,
               const ColourRow& colour) {
  const float y = static_cast<float>(v);
  const auto place = [&](int u, float z) {
    const float x = static_cast<float>(u);
    return std::pair{shader.s.at(x, y) * z - shader.s_shift, shader.t.at(x, y) * z - shader.t_shift};
  };
  for (int u0 = begin; u0 < end; u0 += chunk_px) {
    const int u1 = std::min(u0 + chunk_px, end);
    const int last = u1 - 1;
    const float z0 = 1 / inverse_depth[u0], z1 = 1 / inverse_depth[last];
    const int level = shader.level(static_cast<float>(u0), y, z0, rays[sample].level);
    const auto [s0, t0] = place(u0, z0);
    const auto [s1, t1] = place(last, z1);
    float light = light_at(shader.face->lightmap, s0, t0);
    const float step =
        last > u0 ? (light_at(shader.face->lightmap, s1, t1) - light) / static_cast<float>(last - u0) : 0.0f;
    if (u1 - u0 == Texture::batch) {
      shade_batch(shader, inverse_depth, u0, y, level, light, step, colour);
      continue;
    }
    for (int u = u0; u < u1; ++u) {
      const auto [s, t] = place(u, 1 / inverse_depth[u]);
      const Colour c = shader.texture->sample(s * shader.s_scale + shader.s_offset,
                                              t * shader.t_scale + shader.t_offset, level);
      colour.r[u] += light * c.r;
      colour.g[u] += light * c.g;
      colour.b[u] += light * c.b;
      light += step;
    }
  }
}

Colour shade_point(const Shader& shader, float u, float v, int sample) {
  const float z = 1 / std::max(shader.inverse_depth.at(u, v), 1e-4f);
  const float s = shader.s.at(u, v) * z - shader.s_shift, t = shader.t.at(u, v) * z - shader.t_shift;
  const float light = light_at(shader.face->lightmap, s, t);
  const Colour c =
      shader.texture->sample(s * shader.s_scale + shader.s_offset, t * shader.t_scale + shader.t_offset,
                             shader.level(u, v, z, rays[sample].level));
  return {light * c.r, light * c.g, light * c.b};
}

}  // namespace vsgraphs
