// Paints textures: rectangles, discs, strokes, noise and made-up writing on a small image. Coordinates are fractions of
// the image, x to the right and y downwards, so that a motif can be painted at any size.
#pragma once

#include "core/base/image.h"
#include "core/base/rng.h"

namespace vsgraphs {

class Canvas {
 public:
  Canvas(int width, int height, Rgb background) : image_(width, height, background) {}

  const Image<Rgb>& image() const { return image_; }
  int width() const { return image_.width; }
  int height() const { return image_.height; }

  void fill(double x0, double y0, double x1, double y1, Rgb colour);
  // A frame of the given thickness (fraction of the width) inside the rectangle.
  void outline(double x0, double y0, double x1, double y1, double thickness, Rgb colour);
  // Radius and thickness are fractions of the width; discs stay round on oblong images.
  void disc(double x, double y, double radius, Rgb colour);
  void ring(double x, double y, double radius, double thickness, Rgb colour);
  void stroke(double x0, double y0, double x1, double y1, double thickness, Rgb colour);
  // Darkens or lightens every channel alike: `amplitude` grey levels, features about `cells` per width; repeats seamlessly.
  void mottle(Rng& rng, double amplitude, int cells);
  // Independent noise per texel.
  void grain(Rng& rng, double amplitude);
  // Long streaks along x (wood): noise stretched by `stretch`.
  void streaks(Rng& rng, double amplitude, int cells, double stretch);
  // Lines of made-up words: dark blocks of varying length in a box, `lines` of them.
  void writing(Rng& rng, double x0, double y0, double x1, double y1, int lines, Rgb ink);
  // One made-up capital word, `letters` long, of strokes on a 3 x 5 raster.
  void headline(Rng& rng, double x0, double y0, double x1, double y1, int letters, Rgb ink);

 private:
  void lattice_noise(Rng& rng, double amplitude, int cells_x, int cells_y);
  void add(int u, int v, double value);
  Image<Rgb> image_;
};

Rgb scaled(Rgb colour, double factor);
Rgb blended(Rgb a, Rgb b, double share_of_b);
// A colour of random hue; saturation and value in 0..1.
Rgb random_hue(Rng& rng, double saturation, double value);

}  // namespace vsgraphs
