// Materials made for one face of a thing: doors, fronts, book spines, parcels, screens, rugs, the view outside.
#include <algorithm>

#include "simulate/canvas.h"
#include "simulate/materials.h"

namespace vsgraphs {
namespace {

Canvas door_leaf(Rng& rng, Rgb colour) {
  Canvas c(256, 512, colour);
  c.streaks(rng, 6, 64, 32);
  for (const double y : {0.06, 0.55}) {
    for (const double x : {0.14, 0.55}) {
      c.outline(x, y, x + 0.31, y + 0.39, 0.016, scaled(colour, 0.72));
      c.outline(x + 0.02, y + 0.01, x + 0.29, y + 0.38, 0.012, scaled(colour, 1.08));
    }
  }
  return c;
}

// Fronts of furniture: `columns` x `rows` doors or drawers with handles.
Canvas fronts(Rng& rng, Rgb colour, int columns, int rows) {
  Canvas c(256, 256, colour);
  c.streaks(rng, 8, 64, 16);
  c.streaks(rng, 5, 128, 32);
  const Rgb gap = scaled(colour, 0.45), handle{70, 70, 76};
  c.outline(0, 0, 1, 1, 0.012, scaled(colour, 0.7));
  for (int j = 0; j < rows; ++j) {
    for (int i = 0; i < columns; ++i) {
      const double x = static_cast<double>(i) / columns, y = static_cast<double>(j) / rows;
      const double w = 1.0 / columns, h = 1.0 / rows;
      c.outline(x, y, x + w, y + h, 0.005, gap);
      if (rows > 1)
        c.fill(x + 0.4 * w, y + 0.42 * h, x + 0.6 * w, y + 0.54 * h, handle);
      else
        c.fill(x + (i % 2 ? 0.06 : 0.9) * w, y + 0.4 * h, x + (i % 2 ? 0.1 : 0.94) * w, y + 0.6 * h, handle);
    }
  }
  return c;
}

Canvas spine(Rng& rng) {
  const Rgb cover = random_hue(rng, 0.45, rng.uniform(0.25, 0.65));
  Canvas c(32, 128, cover);
  const Rgb ink = scaled(cover, rng.uniform() < 0.5 ? 0.45 : 1.7);
  const double y = rng.uniform(0.1, 0.3);
  c.fill(0, 0.04, 1, 0.06, ink);
  for (double k = y; k < y + 0.45; k += 0.07)
    c.fill(rng.uniform(0.2, 0.35), k, rng.uniform(0.6, 0.8), k + 0.04, ink);
  c.fill(0, 0.88, 1, 0.91, ink);
  c.grain(rng, 5);
  return c;
}

Canvas parcel(Rng& rng, Rgb colour) {
  Canvas c(256, 256, colour);
  c.mottle(rng, 5, 6);
  c.fill(0.44, 0, 0.56, 1, scaled(colour, 1.18));  // tape
  c.headline(rng, 0.08, 0.3, 0.4, 0.44, 4, scaled(colour, 0.4));
  c.fill(0.64, 0.55, 0.93, 0.9, {222, 222, 218});  // label with a bar code
  for (double x = 0.67; x < 0.9; x += rng.uniform(0.012, 0.03)) c.fill(x, 0.6, x + 0.008, 0.74, {40, 40, 40});
  c.writing(rng, 0.67, 0.77, 0.9, 0.88, 3, {70, 70, 70});
  c.grain(rng, 3);
  return c;
}

Canvas outside(Rng& rng) {
  Canvas c(256, 256, {250, 252, 255});
  for (int i = 0; i < 9; ++i) {
    const double x = rng.uniform(-0.1, 1), w = rng.uniform(0.06, 0.14), h = rng.uniform(0.08, 0.24);
    const Rgb house = random_hue(rng, 0.12, 0.85);
    c.fill(x, 0.92 - h, x + w, 1, house);
    for (double v = 0.94 - h; v < 0.9; v += 0.04)
      for (double u = x + 0.015; u < x + w - 0.02; u += 0.035)
        c.fill(u, v, u + 0.015, v + 0.018, scaled(house, 0.72));
  }
  for (int i = 0; i < 26; ++i)
    c.disc(rng.uniform(), rng.uniform(0.84, 1), rng.uniform(0.015, 0.05),
           blended({120, 170, 110}, {190, 215, 180}, rng.uniform()));
  return c;
}

Canvas screen(Rng& rng) {
  Canvas c(256, 256, {38, 44, 58});
  c.fill(0.04, 0.06, 0.3, 0.92, {60, 70, 90});
  c.writing(rng, 0.07, 0.12, 0.27, 0.7, 8, {150, 160, 180});
  for (int i = 0; i < 3; ++i)
    c.writing(rng, 0.36, 0.1 + 0.28 * i, 0.92, 0.32 + 0.28 * i, 5, random_hue(rng, 0.35, 0.8));
  c.outline(0, 0, 1, 1, 0.025, {20, 20, 22});
  return c;
}

Canvas rug(Rng& rng, Rgb colour) {
  Canvas c(512, 512, colour);
  const Rgb a = scaled(colour, 0.55), b = blended(colour, {230, 210, 160}, 0.7);
  for (const double inset : {0.03, 0.08, 0.13})
    c.outline(inset, inset, 1 - inset, 1 - inset, 0.012, inset > 0.05 ? b : a);
  for (int i = 0; i < 16; ++i)
    c.disc(rng.uniform(0.2, 0.8), rng.uniform(0.2, 0.8), rng.uniform(0.02, 0.07), i % 2 ? a : b);
  c.grain(rng, 10);
  return c;
}

// Keys of a keyboard, with what is printed on them.
Canvas keys(Rng& rng, Rgb colour) {
  Canvas c(512, 256, scaled(colour, 0.62));
  constexpr int rows = 6, columns = 21;
  const double w = 0.96 / columns, h = 0.9 / rows;
  for (int j = 0; j < rows; ++j) {
    for (int i = 0; i < columns; ++i) {
      if (i == 15 || (j == 5 && i > 3 && i < 9)) continue;  // beside the number pad; the space bar
      const double x = 0.02 + i * w, y = 0.05 + j * h;
      c.fill(x + 0.08 * w, y + 0.08 * h, x + 0.9 * w, y + 0.88 * h, scaled(colour, rng.uniform(0.96, 1.05)));
      c.headline(rng, x + 0.28 * w, y + 0.2 * h, x + 0.55 * w, y + 0.6 * h, 1, {50, 50, 54});
    }
  }
  c.fill(0.02 + 4 * w, 0.05 + 5.08 * h, 0.02 + 8.9 * w, 0.05 + 5.88 * h, colour);
  c.grain(rng, 2);
  return c;
}

// A printed page: a heading, paragraphs, often a picture or a table.
Canvas page(Rng& rng, Rgb colour) {
  Canvas c(256, 512, colour);
  c.headline(rng, 0.1, 0.05, 0.1 + rng.uniform(0.4, 0.75), 0.09, 6 + static_cast<int>(rng.index(5)),
             {30, 30, 34});
  double y = 0.13;
  while (y < 0.85) {
    const double height = rng.uniform(0.1, 0.22), end = std::min(0.95, y + height);
    if (rng.uniform() < 0.25) {
      c.fill(0.15, y, 0.85, end - 0.02, random_hue(rng, 0.4, 0.7));
      c.disc(rng.uniform(0.3, 0.7), 0.5 * (y + end), 0.1, random_hue(rng, 0.6, 0.5));
    } else {
      c.writing(rng, 0.1, y, 0.9, end - 0.02, std::max(2, static_cast<int>(height * 60)), {70, 70, 76});
    }
    y = end;
  }
  c.grain(rng, 2);
  return c;
}

// A printed cover: a title, a picture, small print.
Canvas cover(Rng& rng) {
  const Rgb ground = random_hue(rng, rng.uniform(0.1, 0.8), rng.uniform(0.25, 0.95));
  Canvas c(256, 256, ground);
  const Rgb ink = ground.g > 120 ? Rgb{28, 28, 34} : Rgb{236, 234, 226};
  c.headline(rng, 0.08, 0.06, 0.9, 0.2, 5 + static_cast<int>(rng.index(4)), ink);
  for (int i = 0; i < 12; ++i) {
    const double x = rng.uniform(0.1, 0.85), y = rng.uniform(0.28, 0.7), r = rng.uniform(0.03, 0.14);
    const Rgb paint = random_hue(rng, 0.6, rng.uniform(0.2, 0.95));
    if (rng.uniform() < 0.5)
      c.disc(x, y, r, paint);
    else
      c.fill(x - r, y - 0.7 * r, x + r, y + 0.7 * r, paint);
  }
  c.writing(rng, 0.08, 0.76, 0.7, 0.95, 5, ink);
  c.mottle(rng, 8, 24);
  c.grain(rng, 4);
  return c;
}

}  // namespace

PaintedMaterial paint_motif(const Material& m) {
  Rng rng(m.seed, m.kind, 0);
  if (m.kind == "door_leaf") return {door_leaf(rng, m.colour).image()};
  if (m.kind == "drawers") return {fronts(rng, m.colour, 1, 3).image()};
  if (m.kind == "cupboard") return {fronts(rng, m.colour, 2, 1).image()};
  if (m.kind == "spine") return {spine(rng).image()};
  if (m.kind == "parcel") return {parcel(rng, m.colour).image()};
  if (m.kind == "outside") return {outside(rng).image()};
  if (m.kind == "screen") return {screen(rng).image()};
  if (m.kind == "keys") return {keys(rng, m.colour).image()};
  if (m.kind == "page") return {page(rng, m.colour).image()};
  if (m.kind == "cover") return {cover(rng).image()};
  if (m.kind == "rug") return {rug(rng, m.colour).image()};
  return {};
}

}  // namespace vsgraphs
