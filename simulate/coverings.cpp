// Materials that repeat: paint, floors, ceilings, wood, cardboard, cloth.
#include <cmath>
#include <numbers>

#include "simulate/canvas.h"
#include "simulate/materials.h"

namespace vsgraphs {
namespace {

Canvas paint(Rng& rng, Rgb colour) {
  Canvas c(256, 256, colour);
  c.mottle(rng, 1.5, 4);
  c.mottle(rng, 1.0, 16);
  c.grain(rng, 1.5);
  return c;
}

Canvas tiles(Rng& rng, Rgb colour) {
  constexpr int count = 4;
  Canvas c(512, 512, colour);
  for (int j = 0; j < count; ++j) {
    for (int i = 0; i < count; ++i) {
      const Rgb shade =
          blended(scaled(colour, rng.uniform(0.86, 1.08)), {190, 170, 160}, rng.uniform(0, 0.25));
      c.fill(i / 4.0, j / 4.0, (i + 1) / 4.0, (j + 1) / 4.0, shade);
    }
  }
  c.mottle(rng, 9, 10);
  c.mottle(rng, 6, 32);
  c.grain(rng, 3);
  const Rgb grout = scaled(colour, 0.8);
  for (int i = 0; i < count; ++i) {
    c.fill(i / 4.0, 0, i / 4.0 + 0.006, 1, grout);
    c.fill(0, i / 4.0, 1, i / 4.0 + 0.006, grout);
  }
  return c;
}

Canvas planks(Rng& rng, Rgb colour) {
  constexpr int rows = 16;
  Canvas c(512, 512, colour);
  for (int j = 0; j < rows; ++j) {
    const double y0 = static_cast<double>(j) / rows, y1 = static_cast<double>(j + 1) / rows;
    const double joint = rng.uniform(0.1, 0.9);
    c.fill(0, y0, joint, y1, scaled(colour, rng.uniform(0.86, 1.1)));
    c.fill(joint, y0, 1, y1, scaled(colour, rng.uniform(0.86, 1.1)));
  }
  c.streaks(rng, 10, 64, 16);
  c.streaks(rng, 7, 128, 32);
  c.grain(rng, 3);
  for (int j = 0; j < rows; ++j) {
    const double y = static_cast<double>(j) / rows;
    c.fill(0, y, 1, y + 0.003, scaled(colour, 0.62));
  }
  return c;
}

Canvas terrazzo(Rng& rng, Rgb colour) {
  Canvas c(256, 256, colour);
  c.mottle(rng, 6, 16);
  for (int i = 0; i < 420; ++i) {
    const double x = rng.uniform(), y = rng.uniform();
    const Rgb chip = blended(scaled(colour, rng.uniform(0.45, 1.25)), {150, 110, 90}, rng.uniform(0, 0.5));
    c.stroke(x, y, x + rng.uniform(-0.02, 0.02), y + rng.uniform(-0.02, 0.02), rng.uniform(0.006, 0.022),
             chip);
  }
  return c;
}

Canvas brick(Rng& rng, Rgb colour) {
  Canvas c(256, 256, scaled(colour, 1.25));
  constexpr int rows = 8;
  for (int j = 0; j < rows; ++j) {
    for (int i = -1; i < 5; ++i) {
      const double x = (i + 0.5 * (j % 2)) / 4.0;
      c.fill(x + 0.01, (j + 0.08) / rows, x + 0.24, (j + 0.92) / rows,
             scaled(colour, rng.uniform(0.75, 1.1)));
    }
  }
  c.grain(rng, 8);
  return c;
}

// Vertical folds: a sine across the width, `folds` per repeat.
Canvas folds(Rng& rng, Rgb colour, int count, double depth) {
  Canvas c(128, 128, colour);
  for (int u = 0; u < 128; ++u) {
    const double k = 1 + depth * std::sin(2 * std::numbers::pi * count * u / 128.0);
    c.fill(u / 128.0, 0, (u + 1) / 128.0, 1, scaled(colour, k));
  }
  c.grain(rng, 3);
  return c;
}

Canvas noisy(Rng& rng, Rgb colour, double mottle, int cells, double grain) {
  Canvas c(256, 256, colour);
  c.mottle(rng, mottle, cells);
  c.mottle(rng, 0.6 * mottle, 4 * cells);
  c.grain(rng, grain);
  return c;
}

Canvas wood(Rng& rng, Rgb colour) {
  Canvas c(256, 256, colour);
  c.streaks(rng, 9, 16, 8);
  c.streaks(rng, 8, 64, 32);
  c.grain(rng, 2);
  return c;
}

// Skirting boards: short dark grain that shows from across the room.
Canvas grained(Rng& rng, Rgb colour) {
  Canvas c(256, 64, colour);
  c.streaks(rng, 28, 32, 4);
  c.streaks(rng, 32, 64, 4);
  c.grain(rng, 6);
  return c;
}

Canvas panels(Rng& rng, Rgb colour) {
  Canvas c(256, 256, colour);
  c.grain(rng, 3);
  c.fill(0, 0, 0.012, 1, scaled(colour, 0.85));
  c.fill(0, 0, 1, 0.012, scaled(colour, 0.85));
  return c;
}

Canvas leaf(Rng& rng, Rgb colour) {
  Canvas c(64, 64, colour);
  c.mottle(rng, 22, 8);
  for (int i = 0; i < 10; ++i) {
    const double y = rng.uniform();
    c.stroke(0.5, y, rng.uniform(), y + rng.uniform(-0.3, 0.3), 0.03, scaled(colour, 1.5));
  }
  return c;
}

}  // namespace

PaintedMaterial paint_covering(const Material& m) {
  Rng rng(m.seed, m.kind, 0);
  if (m.kind == "paint") return {paint(rng, m.colour).image(), 2.0};
  if (m.kind == "tiles") return {tiles(rng, m.colour).image(), 1.8};
  if (m.kind == "planks") return {planks(rng, m.colour).image(), 1.9};
  if (m.kind == "terrazzo") return {terrazzo(rng, m.colour).image(), 0.9};
  if (m.kind == "carpet") return {noisy(rng, m.colour, 5, 32, 9).image(), 1.0};
  if (m.kind == "concrete") return {noisy(rng, m.colour, 8, 6, 4).image(), 1.2};
  if (m.kind == "panels") return {panels(rng, m.colour).image(), 0.6};
  if (m.kind == "wood") return {wood(rng, m.colour).image(), 0.8};
  if (m.kind == "grained") return {grained(rng, m.colour).image(), 0.8};
  if (m.kind == "lacquer") return {noisy(rng, m.colour, 1.5, 4, 1).image(), 0.8};
  if (m.kind == "cloth") return {noisy(rng, m.colour, 5, 24, 6).image(), 0.5};
  if (m.kind == "cardboard") return {noisy(rng, m.colour, 4, 6, 3).image(), 0.6};
  if (m.kind == "brick") return {brick(rng, m.colour).image(), 0.5};
  if (m.kind == "curtain") return {folds(rng, m.colour, 1, 0.22).image(), 0.16};
  if (m.kind == "ribs") return {folds(rng, m.colour, 2, 0.13).image(), 0.1};
  if (m.kind == "leaf") return {leaf(rng, m.colour).image(), 0.25};
  return {};
}

}  // namespace vsgraphs
