// Internal to core/simulate: colour of a face at a pixel.
#pragma once

#include "core/simulate/materials.h"
#include "core/simulate/scene.h"
#include "core/simulate/visibility.h"

namespace vsgraphs {

inline constexpr int rays_per_pixel = 4;

// Everything one face needs per pixel, in single precision.
struct Shader {
  PixelForm<float> s, t, inverse_depth;
  float s_shift, t_shift;
  float s_scale, t_scale, s_offset, t_offset;  // metres to repeats
  float iz_a, iz_b;
  const Face* face;
  const Texture* texture;

  Shader(const Face& f, const FaceView& view, const MaterialStore::Entry& material);
  // Texture level where a pixel covers about one texel; the geometric mean of both directions, so that floors seen at
  // a slant stay crisp along the way.
  int level(float u, float v, float z, float dither) const;
};

// Adds the light of pixels begin..end of a row that see one face. `inverse_depth`: of the row; `colour`: three floats a pixel.
void shade_run(const Shader& shader, const float* inverse_depth, int begin, int end, int v, int sample,
               float* colour);
// The same of one pixel anywhere.
void shade_point(const Shader& shader, float u, float v, int sample, float* colour);

// Light falling on a face at (s, t).
float light_at(const Lightmap& map, float s, float t);

}  // namespace vsgraphs
