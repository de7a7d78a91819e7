// Materials made for one face that hang on walls: posters, boards, clocks, notices, wall plates.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "simulate/canvas.h"
#include "simulate/marker_bits.h"
#include "simulate/materials.h"

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

Canvas marker(std::uint64_t number) {
  constexpr Rgb white{228, 228, 226}, black{28, 28, 30};
  constexpr double cell = 1.0 / (marker_cells + 2);
  Canvas c(256, 256, white);
  c.fill(cell, cell, 1 - cell, 1 - cell, black);
  for (int i = 0; i < 16; ++i) {
    const double x = (2 + i % 4) * cell, y = (2 + i / 4) * cell;
    if (marker_bits[number] >> (15 - i) & 1) c.fill(x, y, x + cell, y + cell, white);
  }
  return c;
}

}  // namespace

PaintedMaterial paint_print(const Material& m) {
  Rng rng(m.seed, m.kind, 0);
  if (m.kind == "poster") return {poster(rng).image()};
  if (m.kind == "board") return {board(rng, m.aspect).image()};
  if (m.kind == "picture") return {picture(rng).image()};
  if (m.kind == "clock") return {clock(rng).image()};
  if (m.kind == "notice") return {notice(rng).image()};
  if (m.kind == "socket") return {wall_plate(rng, true).image()};
  if (m.kind == "switch") return {wall_plate(rng, false).image()};
  if (m.kind == "marker") return {marker(m.seed).image()};
  return {};
}

}  // namespace vsgraphs
