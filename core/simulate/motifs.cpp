// Materials made for one face: what hangs on walls, stands on shelves or shows through a window.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/simulate/canvas.h"
#include "core/simulate/materials.h"

namespace vsgraphs {
namespace {

Canvas poster(Rng& rng) {
  const Rgb ground = random_hue(rng, 0.35, 0.75);
  Canvas c(256, 512, ground);
  for (int i = 0; i < 7; ++i) {
    const double x = rng.uniform(0.1, 0.9), y = rng.uniform(0.1, 0.65), r = rng.uniform(0.05, 0.22);
    const Rgb ink = random_hue(rng, 0.6, rng.uniform(0.3, 0.95));
    const std::uint32_t shape = rng.index(4);
    if (shape == 0) c.disc(x, y, r, ink);
    if (shape == 1) c.ring(x, y, r, 0.015, ink);
    if (shape == 2) c.stroke(x, y, x + rng.uniform(-0.5, 0.5), y + rng.uniform(-0.3, 0.3), 0.03, ink);
    if (shape == 3) c.fill(x - r, y - 0.5 * r, x + r, y + 0.5 * r, ink);
  }
  c.headline(rng, 0.1, 0.74, 0.1 + rng.uniform(0.35, 0.75), 0.81, 4 + static_cast<int>(rng.index(4)),
             {35, 35, 40});
  c.writing(rng, 0.1, 0.84, 0.8, 0.94, 4, {60, 55, 60});
  c.mottle(rng, 4, 8);
  return c;
}

Canvas board(Rng& rng, double aspect) {
  const Rgb cork{150, 95, 45}, frame{85, 85, 88};
  Canvas c(512, 512, cork);
  c.mottle(rng, 10, 64);
  c.grain(rng, 8);
  const Rgb papers[] = {{232, 165, 165}, {228, 222, 120}, {150, 195, 220}, {225, 225, 220}};
  for (int i = 0; i < 13; ++i) {
    const double w = rng.uniform(0.12, 0.22), h = aspect * w * rng.uniform(0.6, 0.95);
    const double x = rng.uniform(0.05, 0.93 - w), y = rng.uniform(0.05, 0.93 - h);
    c.fill(x, y, x + w, y + h, papers[rng.index(4)]);
    c.headline(rng, x + 0.08 * w, y + 0.1 * h, x + w * rng.uniform(0.4, 0.8), y + 0.25 * h,
               3 + static_cast<int>(rng.index(4)), {40, 40, 45});
    c.writing(rng, x + 0.08 * w, y + 0.35 * h, x + 0.92 * w, y + 0.92 * h, 5, {110, 110, 115});
    c.disc(x + 0.5 * w, y + 0.04 * h, 0.007, random_hue(rng, 0.8, 0.7));
  }
  c.outline(0, 0, 1, 1, 0.02, frame);
  return c;
}

Canvas picture(Rng& rng) {
  const Rgb sky = random_hue(rng, 0.5, 0.7);
  Canvas c(256, 256, sky);
  for (int j = 0; j < 32; ++j) c.fill(0, j / 32.0, 1, (j + 1) / 32.0, scaled(sky, 0.5 + 0.025 * j));
  for (int ridge = 0; ridge < 3; ++ridge) {
    const Rgb hill = random_hue(rng, 0.45, 0.55 - 0.13 * ridge);
    const double base = 0.5 + 0.14 * ridge, a = rng.uniform(0.03, 0.1), f = rng.uniform(4, 12),
                 p = rng.uniform(0, 6);
    for (int i = 0; i < 128; ++i)
      c.fill(i / 128.0, base + a * std::sin(f * i / 128.0 + p), (i + 1) / 128.0, 1, hill);
  }
  for (int i = 0; i < 14; ++i) {
    const double x = rng.uniform(), y = rng.uniform(0.5, 0.85), h = rng.uniform(0.03, 0.12);
    c.fill(x, y - h, x + 0.02 + 0.4 * h, y, random_hue(rng, 0.5, rng.uniform(0.3, 0.95)));
  }
  c.mottle(rng, 10, 32);
  c.outline(0, 0, 1, 1, 0.05, random_hue(rng, 0.3, 0.3));
  return c;
}

Canvas clock(Rng& rng) {
  Canvas c(256, 256, {32, 32, 36});
  c.disc(0.5, 0.5, 0.46, {230, 230, 226});
  for (int i = 0; i < 60; ++i) {
    const double a = 2 * std::numbers::pi * i / 60, inner = i % 5 == 0 ? 0.36 : 0.41;
    c.stroke(0.5 + inner * std::cos(a), 0.5 + inner * std::sin(a), 0.5 + 0.43 * std::cos(a),
             0.5 + 0.43 * std::sin(a), i % 5 == 0 ? 0.02 : 0.008, {40, 40, 40});
  }
  const double hour = rng.uniform(0, 6.28), minute = rng.uniform(0, 6.28);
  c.stroke(0.5, 0.5, 0.5 + 0.22 * std::cos(hour), 0.5 + 0.22 * std::sin(hour), 0.03, {30, 30, 30});
  c.stroke(0.5, 0.5, 0.5 + 0.34 * std::cos(minute), 0.5 + 0.34 * std::sin(minute), 0.02, {30, 30, 30});
  return c;
}

Canvas notice(Rng& rng) {
  Canvas c(256, 256, {228, 228, 222});
  c.headline(rng, 0.1, 0.08, 0.1 + rng.uniform(0.4, 0.8), 0.18, 5, random_hue(rng, 0.7, 0.5));
  c.writing(rng, 0.1, 0.27, 0.9, 0.92, 11, {70, 70, 75});
  return c;
}

Canvas wall_plate(Rng& rng, bool with_holes) {
  Canvas c(64, 64, {226, 226, 222});
  c.outline(0, 0, 1, 1, 0.06, {190, 190, 186});
  if (with_holes) {
    c.ring(0.5, 0.5, 0.32, 0.05, {180, 180, 176});
    c.disc(0.38, 0.5, 0.06, {50, 50, 50});
    c.disc(0.62, 0.5, 0.06, {50, 50, 50});
  }
  c.grain(rng, 2);
  return c;
}

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

}  // namespace

PaintedMaterial paint_motif(const Material& m) {
  Rng rng(m.seed, m.kind, 0);
  if (m.kind == "poster") return {poster(rng).image()};
  if (m.kind == "board") return {board(rng, m.aspect).image()};
  if (m.kind == "picture") return {picture(rng).image()};
  if (m.kind == "clock") return {clock(rng).image()};
  if (m.kind == "notice") return {notice(rng).image()};
  if (m.kind == "socket") return {wall_plate(rng, true).image()};
  if (m.kind == "switch") return {wall_plate(rng, false).image()};
  if (m.kind == "door_leaf") return {door_leaf(rng, m.colour).image()};
  if (m.kind == "drawers") return {fronts(rng, m.colour, 1, 3).image()};
  if (m.kind == "cupboard") return {fronts(rng, m.colour, 2, 1).image()};
  if (m.kind == "spine") return {spine(rng).image()};
  if (m.kind == "parcel") return {parcel(rng, m.colour).image()};
  if (m.kind == "outside") return {outside(rng).image()};
  if (m.kind == "screen") return {screen(rng).image()};
  if (m.kind == "rug") return {rug(rng, m.colour).image()};
  return {};
}

}  // namespace vsgraphs
