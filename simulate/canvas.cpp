#include "simulate/canvas.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace vsgraphs {
namespace {

std::uint8_t byte(double x) { return static_cast<std::uint8_t>(std::clamp(x, 0.0, 255.0) + 0.5); }

}  // namespace

Rgb scaled(Rgb c, double k) { return {byte(c.r * k), byte(c.g * k), byte(c.b * k)}; }

Rgb blended(Rgb a, Rgb b, double k) {
  return {byte(a.r + k * (b.r - a.r)), byte(a.g + k * (b.g - a.g)), byte(a.b + k * (b.b - a.b))};
}

Rgb random_hue(Rng& rng, double saturation, double value) {
  const double h = 6 * rng.uniform();
  const auto channel = [&](double offset) {
    const double k = std::fmod(offset + h, 6.0);
    return byte(255 * value * (1 - saturation * std::clamp(std::min(k, 4 - k), 0.0, 1.0)));
  };
  return {channel(5), channel(3), channel(1)};
}

void Canvas::fill(double x0, double y0, double x1, double y1, Rgb colour) {
  const auto edge = [](double f, int size) {
    return std::clamp(static_cast<int>(std::lround(f * size)), 0, size);
  };
  for (int v = edge(y0, height()); v < edge(y1, height()); ++v)
    for (int u = edge(x0, width()); u < edge(x1, width()); ++u) image_.at(u, v) = colour;
}

void Canvas::outline(double x0, double y0, double x1, double y1, double thickness, Rgb colour) {
  const double ty = thickness * width() / height();
  fill(x0, y0, x1, y0 + ty, colour);
  fill(x0, y1 - ty, x1, y1, colour);
  fill(x0, y0, x0 + thickness, y1, colour);
  fill(x1 - thickness, y0, x1, y1, colour);
}

void Canvas::disc(double x, double y, double radius, Rgb colour) { stroke(x, y, x, y, 2 * radius, colour); }

void Canvas::ring(double x, double y, double radius, double thickness, Rgb colour) {
  constexpr int pieces = 48;
  const double aspect = static_cast<double>(width()) / height();
  for (int i = 0; i < pieces; ++i) {
    const double a = 2 * std::numbers::pi * i / pieces, b = 2 * std::numbers::pi * (i + 1) / pieces;
    stroke(x + radius * std::cos(a), y + aspect * radius * std::sin(a), x + radius * std::cos(b),
           y + aspect * radius * std::sin(b), thickness, colour);
  }
}

void Canvas::stroke(double x0, double y0, double x1, double y1, double thickness, Rgb colour) {
  const double ax = x0 * width(), ay = y0 * height(), dx = (x1 - x0) * width(), dy = (y1 - y0) * height();
  const double r = 0.5 * thickness * width(), length2 = dx * dx + dy * dy;
  const int u0 = std::max(0, static_cast<int>(std::min(ax, ax + dx) - r));
  const int u1 = std::min(width() - 1, static_cast<int>(std::max(ax, ax + dx) + r) + 1);
  const int v0 = std::max(0, static_cast<int>(std::min(ay, ay + dy) - r));
  const int v1 = std::min(height() - 1, static_cast<int>(std::max(ay, ay + dy) + r) + 1);
  for (int v = v0; v <= v1; ++v) {
    for (int u = u0; u <= u1; ++u) {
      const double px = u + 0.5 - ax, py = v + 0.5 - ay;
      const double t = length2 > 0 ? std::clamp((px * dx + py * dy) / length2, 0.0, 1.0) : 0.0;
      const double distance = std::hypot(px - t * dx, py - t * dy);
      const double cover = std::clamp(r + 0.5 - distance, 0.0, 1.0);
      if (cover > 0) image_.at(u, v) = blended(image_.at(u, v), colour, cover);
    }
  }
}

void Canvas::add(int u, int v, double value) {
  Rgb& c = image_.at(u, v);
  c = {byte(c.r + value), byte(c.g + value), byte(c.b + value)};
}

void Canvas::lattice_noise(Rng& rng, double amplitude, int cells_x, int cells_y) {
  std::vector<double> nodes(static_cast<std::size_t>(cells_x) * cells_y);
  for (double& n : nodes) n = amplitude * rng.uniform(-1, 1);
  const auto node = [&](int i, int j) {
    return nodes[static_cast<std::size_t>(j % cells_y) * cells_x + i % cells_x];
  };
  const auto ease = [](double t) { return t * t * (3 - 2 * t); };
  for (int v = 0; v < height(); ++v) {
    const double y = static_cast<double>(v) * cells_y / height();
    const int j = static_cast<int>(y);
    const double fy = ease(y - j);
    for (int u = 0; u < width(); ++u) {
      const double x = static_cast<double>(u) * cells_x / width();
      const int i = static_cast<int>(x);
      const double fx = ease(x - i);
      add(u, v,
          (1 - fy) * ((1 - fx) * node(i, j) + fx * node(i + 1, j)) +
              fy * ((1 - fx) * node(i, j + 1) + fx * node(i + 1, j + 1)));
    }
  }
}

void Canvas::mottle(Rng& rng, double amplitude, int cells) {
  lattice_noise(rng, amplitude, cells, std::max(1, cells * height() / width()));
}

void Canvas::streaks(Rng& rng, double amplitude, int cells, double stretch) {
  lattice_noise(rng, amplitude, std::max(1, static_cast<int>(cells / stretch)),
                std::max(1, cells * height() / width()));
}

void Canvas::grain(Rng& rng, double amplitude) {
  for (int v = 0; v < height(); ++v)
    for (int u = 0; u < width(); ++u) add(u, v, amplitude * rng.uniform(-1, 1));
}

void Canvas::writing(Rng& rng, double x0, double y0, double x1, double y1, int lines, Rgb ink) {
  const double pitch = (y1 - y0) / lines;
  for (int i = 0; i < lines; ++i) {
    const double end = i + 1 == lines ? x0 + (x1 - x0) * rng.uniform(0.3, 0.9) : x1;
    double x = x0;
    while (x < end) {
      const double word = std::min(end - x, (x1 - x0) * rng.uniform(0.06, 0.25));
      fill(x, y0 + pitch * (i + 0.2), x + word, y0 + pitch * (i + 0.65), ink);
      x += word + 0.03 * (x1 - x0);
    }
  }
}

void Canvas::headline(Rng& rng, double x0, double y0, double x1, double y1, int letters, Rgb ink) {
  const double cell_x = (x1 - x0) / (letters * 4 - 1), cell_y = (y1 - y0) / 5;
  for (int letter = 0; letter < letters; ++letter) {
    // A raster with its left column filled most of the time looks like capitals from a distance.
    for (int j = 0; j < 5; ++j) {
      for (int i = 0; i < 3; ++i) {
        const double chance = i == 0 ? 0.9 : (j % 2 == 0 ? 0.75 : 0.35);
        if (rng.uniform() > chance) continue;
        const double x = x0 + cell_x * (letter * 4 + i), y = y0 + cell_y * j;
        fill(x, y, x + cell_x, y + cell_y, ink);
      }
    }
  }
}

}  // namespace vsgraphs
