#include "simulate/lens.h"

#include <algorithm>
#include <cmath>

#include "core/base/check.h"

namespace vsgraphs {
namespace {

using Eigen::Vector2d;

constexpr double steepest =
    4.0;  // x/z beyond which a pinhole image grows too large: 76 degrees from the axis
constexpr int newton_steps = 30;

std::size_t most_coefficients(const std::string& model) {
  if (model == "radial_tangential") return 5;
  return model == "kannala_brandt" ? 4 : model == "rational" ? 8 : 0;
}

double coefficient(const std::vector<double>& k, std::size_t i) { return i < k.size() ? k[i] : 0.0; }

Vector2d kannala_brandt(const std::vector<double>& k, const Vector2d& p) {
  const double r = p.norm();
  if (r < 1e-12) return p;
  const double theta = std::atan(r), t2 = theta * theta;
  double scale = 0;
  for (std::size_t i = 4; i-- > 0;) scale = t2 * (coefficient(k, i) + scale);
  return p * (theta * (1 + scale) / r);
}

Vector2d rational(const std::vector<double>& k, const Vector2d& p) {
  const double r2 = p.squaredNorm(), x = p.x(), y = p.y();
  const double p1 = coefficient(k, 2), p2 = coefficient(k, 3);
  const double above = 1 + r2 * (coefficient(k, 0) + r2 * (coefficient(k, 1) + r2 * coefficient(k, 4)));
  const double below = 1 + r2 * (coefficient(k, 5) + r2 * (coefficient(k, 6) + r2 * coefficient(k, 7)));
  return p * (above / below) +
         Vector2d(2 * p1 * x * y + p2 * (r2 + 2 * x * x), p1 * (r2 + 2 * y * y) + 2 * p2 * x * y);
}

Vector2d radial_tangential(const std::vector<double>& k, const Vector2d& p) {
  Camera camera;  // the model every reader of a sequence uses
  camera.fx = camera.fy = 1, camera.cx = camera.cy = 0;
  for (std::size_t i = 0; i < 5; ++i) camera.distortion[i] = coefficient(k, i);
  return camera.distort(p);
}

}  // namespace

void Lens::validate() const {
  require_input(
      model == "none" || most_coefficients(model) > 0,
      "lens: must be one of none, radial_tangential, kannala_brandt, rational, not \"" + model + "\"");
  const std::size_t most = most_coefficients(model);
  require_input(k.size() <= most, "lens: " + model + " has at most " + std::to_string(most) +
                                      " coefficients, not " + std::to_string(k.size()));
  for (const double c : k) require_input(std::isfinite(c), "lens: a coefficient is not finite");
}

Vector2d Lens::distort(const Vector2d& ideal) const {
  if (model == "kannala_brandt") return kannala_brandt(k, ideal);
  if (model == "rational") return rational(k, ideal);
  return model == "radial_tangential" ? radial_tangential(k, ideal) : ideal;
}

Vector2d Lens::undistort(const Vector2d& bent) const {
  Vector2d p = bent;
  if (model == "kannala_brandt")  // as if there were no coefficients
    p = bent * (std::tan(std::min(bent.norm(), 1.4)) / std::max(bent.norm(), 1e-12));
  return undistort(bent, p);
}

Vector2d Lens::undistort(const Vector2d& bent, const Vector2d& near) const {
  Vector2d p = near;
  for (int i = 0; i < newton_steps; ++i) {
    const Vector2d error = bent - distort(p);
    if (error.norm() < 1e-12) break;
    constexpr double h = 1e-6;
    Eigen::Matrix2d j;
    j.col(0) = (distort(p + Vector2d(h, 0)) - distort(p - Vector2d(h, 0))) / (2 * h);
    j.col(1) = (distort(p + Vector2d(0, h)) - distort(p - Vector2d(0, h))) / (2 * h);
    const double det = j(0, 0) * j(1, 1) - j(0, 1) * j(1, 0);
    Vector2d step =
        Vector2d(j(1, 1) * error.x() - j(0, 1) * error.y(), j(0, 0) * error.y() - j(1, 0) * error.x()) / det;
    if (const double most = 0.3 * (1 + p.norm()); step.norm() > most) step *= most / step.norm();
    p += step;
  }
  require_input(
      (bent - distort(p)).norm() < 1e-8 && p.cwiseAbs().maxCoeff() < steepest,
      "lens: bends too much for this image: its corners look more than 76 degrees from the axis, or nowhere");
  return p;
}

LensMap::LensMap(const Camera& camera, const Lens& lens, const std::vector<Vector2d>& offsets)
    : pinhole_(camera) {
  lens.validate();
  // One point per pixel is sought; places within it are taken from its neighbours.
  const Vector2d focal(camera.fx, camera.fy);
  Image<Vector2d> ideal(camera.width + 1, camera.height + 1, Vector2d(0, 0));
  Vector2d low(0, 0), high(0, 0);
  for (int v = 0; v <= camera.height; ++v) {
    for (int u = 0; u <= camera.width; ++u) {
      const Vector2d bent((u - camera.cx) / camera.fx, (v - camera.cy) / camera.fy);
      const Vector2d p = u == 0 && v == 0
                             ? lens.undistort(bent)
                             : lens.undistort(bent, ideal.at(std::max(0, u - 1), u > 0 ? v : v - 1));
      ideal.at(u, v) = p;
      low = low.cwiseMin(p.cwiseProduct(focal)), high = high.cwiseMax(p.cwiseProduct(focal));
    }
  }
  for (const Vector2d& offset : offsets) {
    Image<Eigen::Vector2f>& map = maps_.emplace_back(camera.width, camera.height, Eigen::Vector2f(0, 0));
    for (int v = 0; v < camera.height; ++v) {
      for (int u = 0; u < camera.width; ++u) {
        const Vector2d here = ideal.at(u, v);
        const Vector2d there =
            here + offset.x() * (ideal.at(u + 1, v) - here) + offset.y() * (ideal.at(u, v + 1) - here);
        map.at(u, v) = there.cwiseProduct(focal).cast<float>();
      }
    }
  }
  low -= Vector2d(1, 1), high += Vector2d(1, 1);  // for the places within the first and last pixels
  // Whole pixels from the lens's centre, so that a straight lens picks each pixel's own place.
  pinhole_.cx = camera.cx + std::ceil(-low.x() - camera.cx) + 1;
  pinhole_.cy = camera.cy + std::ceil(-low.y() - camera.cy) + 1;
  pinhole_.width = static_cast<int>(std::ceil(high.x() + pinhole_.cx)) + 2;
  pinhole_.height = static_cast<int>(std::ceil(high.y() + pinhole_.cy)) + 2;
  const Eigen::Vector2f centre(static_cast<float>(pinhole_.cx), static_cast<float>(pinhole_.cy));
  for (auto& map : maps_)
    for (Eigen::Vector2f& p : map.pixels) p += centre;
}

std::array<int, 2> LensMap::rows(int begin, int end) const {
  float low = 1e9f, high = -1e9f;
  for (const auto& map : maps_) {
    for (int v = begin; v < end; ++v) {
      for (int u = 0; u < map.width; ++u) {
        low = std::min(low, map.at(u, v).y());
        high = std::max(high, map.at(u, v).y());
      }
    }
  }
  return {std::max(0, static_cast<int>(low) - 1), static_cast<int>(high) + 2};
}

}  // namespace vsgraphs
