#include "core/scene/rooms/clearance.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

namespace vsgraphs {
namespace {

constexpr double infinite = 1e12;  // squared cells; finite, so that differences stay numbers

// Lower envelope of parabolas rooted at each sample: in place, squared distances along one line.
class LineTransform {
 public:
  explicit LineTransform(std::size_t longest) : roots_(longest), from_(longest + 1), result_(longest) {}

  void apply(std::vector<double>& line) {
    const int n = static_cast<int>(line.size());
    int k = 0;
    roots_[0] = 0;
    from_[0] = -std::numeric_limits<double>::infinity();
    from_[1] = std::numeric_limits<double>::infinity();
    for (int q = 1; q < n; ++q) {
      double s = meeting(line, roots_[k], q);
      while (s <= from_[k]) s = meeting(line, roots_[--k], q);
      roots_[++k] = q;
      from_[k] = s;
      from_[k + 1] = std::numeric_limits<double>::infinity();
    }
    for (int q = 0, j = 0; q < n; ++q) {
      while (from_[j + 1] < q) ++j;
      const double d = q - roots_[j];
      result_[static_cast<std::size_t>(q)] = d * d + line[static_cast<std::size_t>(roots_[j])];
    }
    std::copy_n(result_.begin(), n, line.begin());
  }

 private:
  static double meeting(const std::vector<double>& line, int p, int q) {
    const double fp = line[static_cast<std::size_t>(p)] + static_cast<double>(p) * p;
    const double fq = line[static_cast<std::size_t>(q)] + static_cast<double>(q) * q;
    return (fq - fp) / (2.0 * (q - p));
  }
  std::vector<int> roots_;
  std::vector<double> from_, result_;
};

}  // namespace

GridValues<float> clearance_field(const GridFrame& frame, const GridValues<char>& passable) {
  // A rim of blocked cells stands for the world outside.
  const int w = frame.width + 2, h = frame.height + 2;
  std::vector<double> squared(static_cast<std::size_t>(w) * static_cast<std::size_t>(h), 0.0);
  const auto at = [&](int x, int y) -> double& { return squared[static_cast<std::size_t>(y * w + x)]; };
  for (int i = 0; i < frame.size(); ++i)
    if (passable[static_cast<std::size_t>(i)]) at(i % frame.width + 1, i / frame.width + 1) = infinite;
  LineTransform transform(static_cast<std::size_t>(std::max(w, h)));
  std::vector<double> line(static_cast<std::size_t>(h));
  for (int x = 0; x < w; ++x) {
    for (int y = 0; y < h; ++y) line[static_cast<std::size_t>(y)] = at(x, y);
    transform.apply(line);
    for (int y = 0; y < h; ++y) at(x, y) = line[static_cast<std::size_t>(y)];
  }
  line.resize(static_cast<std::size_t>(w));
  GridValues<float> clearance(static_cast<std::size_t>(frame.size()));
  for (int y = 1; y + 1 < h; ++y) {
    for (int x = 0; x < w; ++x) line[static_cast<std::size_t>(x)] = at(x, y);
    transform.apply(line);
    for (int x = 1; x + 1 < w; ++x)
      clearance[static_cast<std::size_t>((y - 1) * frame.width + x - 1)] =
          static_cast<float>(std::sqrt(line[static_cast<std::size_t>(x)]) * frame.cell_m);
  }
  return clearance;
}

}  // namespace vsgraphs
