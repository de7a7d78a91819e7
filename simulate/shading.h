// Internal to core/simulate: colour of a face at a pixel.
#pragma once

#include "simulate/materials.h"
#include "simulate/scene.h"
#include "simulate/visibility.h"

namespace vsgraphs {

// Rays through a pixel: four on a rotated grid, or two where sensors are soft and the camera hardly moves; a `sample` is an index here.
struct Ray {
  float offset_u, offset_v;
  float level;  // added to the texture level: fractions with which the rays of a pixel filter between levels
};
inline constexpr int rays_per_pixel = 4, first_of_two = 4;
inline constexpr Ray rays[] = {{-0.125f, -0.375f, 0.0f}, {0.375f, -0.125f, 0.5f}, {-0.375f, 0.125f, 0.25f},
                               {0.125f, 0.375f, 0.75f},  {-0.25f, -0.25f, 0.4f},  {0.25f, 0.25f, 0.9f}};

// Sums of light, a row's red, green and blue one after the other.
struct ColourRow {
  float *r, *g, *b;
};

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

// Adds the light of pixels begin..end of a row that see one face. `inverse_depth`: of the row.
void shade_run(const Shader& shader, const float* inverse_depth, int begin, int end, int v, int sample,
               const ColourRow& colour);
// Light of one pixel anywhere.
Colour shade_point(const Shader& shader, float u, float v, int sample);

// Light falling on a face at (s, t).
float light_at(const Lightmap& map, float s, float t);

}  // namespace vsgraphs
