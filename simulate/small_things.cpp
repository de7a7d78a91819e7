// What lies and stands on tables: keyboards, papers, magazines, mugs, pens.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "simulate/canvas.h"
#include "simulate/furniture.h"

namespace vsgraphs {
namespace {

using Eigen::Vector3d;

// A sheet of a stack: turned a little, with its print on top; so small that it stays on its footprint.
void sheet(Piece& p, const Material& print, double turn, double low, double high) {
  const double c = std::cos(turn), s = std::sin(turn), wide = std::abs(s);
  const double share = std::min(p.w / (p.w * c + p.d * wide), p.d / (p.d * c + p.w * wide));
  const Eigen::Vector2d x(c * p.stand.x.x() - s * p.stand.x.y(), s * p.stand.x.x() + c * p.stand.x.y());
  const Stand stand{p.stand.origin, x};
  const double w = share * p.w, d = share * p.d;
  p.builder.add_box(p.tag, stand, {-w, -d, low}, {w, d, high}, {"lacquer", 7, {214, 212, 204}},
                    all_sides & ~(BoxSide::bottom | BoxSide::top));
  const Vector3d corner = stand.at({w, d, high});
  p.builder.add_rectangle(p.tag, corner, stand.direction({-1, 0, 0}), stand.direction({0, -1, 0}),
                          {2 * w, 2 * d}, print);
}

// An upright prism with eight sides.
void prism(Piece& p, const Vector3d& foot, double radius, double height, const Material& material) {
  constexpr int sides = 8;
  const auto corner = [&](int k) -> Vector3d {
    const double a = 2 * std::numbers::pi * k / sides;
    return foot + Vector3d(radius * std::cos(a), radius * std::sin(a), 0);
  };
  Polygon2 lid;
  for (int k = 0; k < sides; ++k) {
    const Vector3d a = corner(k), b = corner(k + 1), along = (b - a).normalized();
    p.builder.add_rectangle(p.tag, p.stand.at(a), p.stand.direction(along),
                            p.stand.direction(Vector3d::UnitZ()), {(b - a).norm(), height}, material);
    lid.emplace_back(a.x() - foot.x() + radius, a.y() - foot.y() + radius);
  }
  p.builder.add_face(p.tag, p.stand.at(foot + Vector3d(-radius, -radius, height)),
                     p.stand.direction(Vector3d::UnitX()), p.stand.direction(Vector3d::UnitY()),
                     {2 * radius, 2 * radius}, {lid}, {"lacquer", 7, scaled(material.colour, 0.5)});
}

}  // namespace

void keyboard(Piece& p) {
  const Material side{"lacquer", 7, scaled(p.colour, 0.8)};
  p.box({-p.w, -p.d, 0}, {p.w, p.d, p.h}, side, all_sides & ~(BoxSide::top | BoxSide::bottom));
  sheet(p, {"keys", p.seed, p.colour}, 0, 0, p.h);
}

void papers(Piece& p) {
  Rng rng(p.seed, "papers", 0);
  const int count = std::clamp(static_cast<int>(p.h / 0.002), 1, 5);
  for (int i = 0; i < count; ++i)
    sheet(p, {"page", rng.index(12), {226, 225, 220}}, rng.uniform(-0.25, 0.25), p.h * i / count,
          p.h * (i + 1) / count);
}

void magazine(Piece& p) {
  Rng rng(p.seed, "magazine", 0);
  sheet(p, {"cover", p.seed, {255, 255, 255}}, rng.uniform(-0.15, 0.15), 0, p.h);
}

void mug(Piece& p) { prism(p, {0, 0, 0}, std::min(p.w, p.d), p.h, {"cover", p.seed, p.colour}); }

void pens(Piece& p) {
  Rng rng(p.seed, "pens", 0);
  prism(p, {0, 0, 0}, std::min(p.w, p.d), 0.6 * p.h, {"lacquer", 7, {60, 66, 74}});
  for (int i = 0; i < 9; ++i) {
    const double a = rng.uniform(0, 2 * std::numbers::pi), r = 0.6 * std::min(p.w, p.d) * rng.uniform(),
                 t = 0.004;
    const double x = r * std::cos(a), y = r * std::sin(a);
    p.box({x - t, y - t, 0.6 * p.h}, {x + t, y + t, p.h * rng.uniform(0.75, 1.0)},
          {"lacquer", 7, random_hue(rng, 0.8, rng.uniform(0.2, 0.9))}, all_sides & ~BoxSide::bottom);
  }
}

// Stands on its lower edge, its cover to the front.
void booklet(Piece& p) {
  p.box({-p.w, -p.d, 0}, {p.w, p.d, p.h}, {"lacquer", 7, {206, 204, 198}}, all_sides & ~BoxSide::bottom,
        Material{"cover", p.seed, {255, 255, 255}});
}

void carton(Piece& p) {
  p.box({-p.w, -p.d, 0}, {p.w, p.d, p.h}, {"cover", p.seed, p.colour}, all_sides & ~BoxSide::bottom);
}

}  // namespace vsgraphs
