// Internal to core/simulate: what a structured-light RGB-D camera makes of an exact image. Depth after Handa, Whelan,
// McDonald, Davison, "A benchmark for RGB-D visual odometry, 3D reconstruction and SLAM" (ICRA 2014): disparity in steps
// with sub-pixel noise; holes where matching fails.
#pragma once

#include <vector>

#include "simulate/renderer.h"

namespace vsgraphs {

// Cosine of the angle between a pixel's ray and the plane with this inverse-depth form.
float incidence_cosine(const Camera& camera, const PixelForm<double>& inverse_depth_form,
                       double inverse_depth, double u, double v);

// What a depth sensor looks at, exact, pixel by pixel. Empty images: not asked for.
struct ExactDepth {
  Image<std::uint16_t> depth;  // camera units
  Image<std::uint8_t> label;   // SceneClass
  Image<float> incidence;      // cosine between ray and normal
  Image<std::uint16_t> pane;   // a pane of glass before it: its depth in camera units; 0: none
  Image<float> pane_incidence;
  const Image<Rgb>* colour = nullptr;
};

// `exact`: depth in camera units; `incidence` may be empty without holes. About 8 ms at 640x480. The sensor "classic".
Image<std::uint16_t> sense_depth(const NoiseOptions& noise, const Camera& camera, int frame,
                                 const Image<std::uint16_t>& exact, const Image<std::uint8_t>& label,
                                 const Image<float>& incidence);
// By the sensor the options name.
Image<std::uint16_t> sense(const NoiseOptions& noise, const Camera& camera, int frame,
                           const ExactDepth& view);

// Brightness factor at a time: a slow wander around 1.
float exposure_gain(const NoiseOptions& noise, double time_s);

// Sums of light (a row's red, green and blue one after the other) times `scale` to 8 bits, with image noise where it is on. About 3 ms at 640x480.
void develop(const NoiseOptions& noise, int frame, float scale, const std::vector<float>& colour,
             Image<Rgb>& rgb);

}  // namespace vsgraphs
