// Poses, landmarks and planes in Ceres, with its own derivatives and planes as n.x + d = 0: both solvers must reach the
// same optimum.
#include "core/base/rng.h"
#include "core/solve/ceres_oracle_test.h"
#include "core/solve/factors/plane_observation.h"
#include "core/solve/factors/plane_parallel.h"
#include "core/solve/factors/plane_perpendicular.h"
#include "core/solve/factors/plane_prior.h"
#include "core/solve/synthetic_window_test.h"

namespace vsgraphs {
namespace {

// The whitened difference to an estimate, of a plane (normal, d) given in the estimate's frame.
struct Difference {
  PlaneEstimate seen;
  Eigen::Matrix3d root;

  explicit Difference(const PlaneEstimate& estimate)
      : seen(estimate), root(Eigen::LLT<Eigen::Matrix3d>(estimate.information).matrixU()) {}

  template <typename T>
  Vector3<T> of(const Vector3<T>& normal, const T& d) const {
    const Eigen::Matrix<T, 2, 1> t = tangent_basis(seen.plane.normal).cast<T>().transpose() * normal;
    const T sine = t.norm(), cosine = seen.plane.normal.cast<T>().dot(normal);
    const T offset = normal.dot(seen.plane.anchor.cast<T>()) + d - T(seen.plane.offset_m);
    const T scale = atan2(sine, cosine) / sine;
    return root.cast<T>() * Vector3<T>(scale * t.x(), scale * t.y(), offset);
  }
};

struct Seen : Difference {
  using Difference::Difference;
  template <typename T>
  bool operator()(const T* q, const T* t, const T* n, const T* d, T* residual) const {
    const Eigen::Map<const Eigen::Quaternion<T>> rotation(q);
    const Eigen::Map<const Vector3<T>> translation(t), normal(n);
    const Vector3<T> in_camera = rotation.conjugate() * normal;
    Eigen::Map<Vector3<T>>{residual} = of<T>(in_camera, *d + normal.dot(translation));
    return true;
  }
};

struct Known : Difference {
  using Difference::Difference;
  template <typename T>
  bool operator()(const T* n, const T* d, T* residual) const {
    Eigen::Map<Vector3<T>>{residual} = of<T>(Eigen::Map<const Vector3<T>>(n), *d);
    return true;
  }
};

struct Parallel {
  double inv_sigma;
  template <typename T>
  bool operator()(const T* a, const T* b, T* residual) const {
    // Its square is sin^2, here from the part of b across a.
    const Eigen::Map<const Vector3<T>> na(a), nb(b);
    Eigen::Map<Vector3<T>>{residual} = T(inv_sigma) * (nb - na.dot(nb) * na);
    return true;
  }
};

struct Perpendicular {
  double inv_sigma;
  template <typename T>
  bool operator()(const T* a, const T* b, T* residual) const {
    residual[0] = T(inv_sigma) * Eigen::Map<const Vector3<T>>(a).dot(Eigen::Map<const Vector3<T>>(b));
    return true;
  }
};

struct PlaneParameters {
  std::array<double, 3> normal;
  double d;
};

// Every relation goes into our problem and into Ceres.
class BothSolvers {
 public:
  BothSolvers(BundleProblem& problem, const BundleOptions& options)
      : problem_(problem), oracle_(problem, options), planes_(problem.structures.planes.size()) {
    for (std::size_t i = 0; i < planes_.size(); ++i) {
      const AnchoredPlane& plane = problem.structures.planes[i];
      Eigen::Map<Eigen::Vector3d>(planes_[i].normal.data()) = plane.normal;
      planes_[i].d = plane.d();
      oracle_.problem().AddParameterBlock(planes_[i].normal.data(), 3, new ceres::SphereManifold<3>);
    }
  }

  void observe(int pose, int plane, const PlaneEstimate& seen) {
    PoseParameters& t = oracle_.parameters(pose);
    add(new ceres::AutoDiffCostFunction<Seen, 3, 4, 3, 3, 1>(new Seen(seen)),
        std::make_unique<PlaneObservationFactor>(pose, plane, seen),
        {t.q.data(), t.t.data(), normal(plane), &planes_[static_cast<std::size_t>(plane)].d});
  }
  void know(int plane, const PlaneEstimate& known) {
    add(new ceres::AutoDiffCostFunction<Known, 3, 3, 1>(new Known(known)),
        std::make_unique<PlanePrior>(plane, known),
        {normal(plane), &planes_[static_cast<std::size_t>(plane)].d});
  }
  void hold_parallel(int a, int b, const PlaneAngle& angle) {
    add(new ceres::AutoDiffCostFunction<Parallel, 3, 3, 3>(new Parallel{angle.inv_sigma()}),
        std::make_unique<PlaneParallel>(a, b, angle), {normal(a), normal(b)});
  }
  void hold_perpendicular(int a, int b, const PlaneAngle& angle) {
    add(new ceres::AutoDiffCostFunction<Perpendicular, 1, 3, 3>(new Perpendicular{angle.inv_sigma()}),
        std::make_unique<PlanePerpendicular>(a, b, angle), {normal(a), normal(b)});
  }

  CeresBundle& oracle() { return oracle_; }
  AnchoredPlane plane_of_oracle(std::size_t i) const {
    const Eigen::Map<const Eigen::Vector3d> n(planes_[i].normal.data());
    return AnchoredPlane{n, Eigen::Vector3d::Zero(), planes_[i].d}.anchored_at(
        problem_.structures.planes[i].anchor);
  }

 private:
  double* normal(int plane) { return planes_[static_cast<std::size_t>(plane)].normal.data(); }
  void add(ceres::CostFunction* cost, std::unique_ptr<const DenseFactor> ours,
           const std::vector<double*>& parameters) {
    oracle_.problem().AddResidualBlock(cost, CeresBundle::loss_of(ours->robust()), parameters);
    problem_.factors.push_back(std::move(ours));
  }

  BundleProblem& problem_;
  CeresBundle oracle_;
  std::vector<PlaneParameters> planes_;
};

// Two walls that nearly face each other, a third nearly across, a ground: around the window's cameras.
std::vector<AnchoredPlane> room() {
  return {{Eigen::Vector3d(0.03, 0, -1).normalized(), {0, 0, 4}, 0},
          {Eigen::Vector3d(0.02, 0.01, 1).normalized(), {0, 0, -3}, 0},
          {Eigen::Vector3d(1, 0.01, 0.05).normalized(), {-3, 0, 1}, 0},
          {Eigen::Vector3d(0.01, -1, 0.02).normalized(), {0, 1.3, 1}, 0}};
}

// Tilts to 0.3 to 0.5 deg, the offset to 5 mm, related to each other.
const Eigen::Matrix3d information = [] {
  Eigen::Matrix3d root;
  root << 180, 0, 0, 40, 120, 0, -30, 20, 200;
  return Eigen::Matrix3d(root * root.transpose());
}();

// What the camera at `pose` sees of the plane at a patch `patch` (camera frame), with noise.
PlaneEstimate sighting(const AnchoredPlane& plane, const Se3& pose, const Eigen::Vector3d& patch,
                       double wrong, Rng& rng) {
  const AnchoredPlane in_camera = plane.transformed(pose.inverse()).anchored_at(patch);
  const Eigen::Vector3d noise(0.007 * rng.normal() + wrong, 0.007 * rng.normal(),
                              0.005 * rng.normal() + wrong);
  return {in_camera.retract(noise), information};
}

void expect_same_structure(int landmarks, std::uint64_t seed, double wrong_share) {
  SyntheticWindowOptions options;
  options.fixed_poses = 2;
  options.free_poses = 6;
  options.landmarks = landmarks;
  SyntheticWindow w = synthetic_window(options, seed);
  Rng rng(seed, "ceres_structure_test", 0);
  const std::vector<AnchoredPlane> truth = room();
  for (const AnchoredPlane& plane : truth)
    w.problem.structures.planes.push_back(
        plane.retract({0.05 * rng.normal(), 0.05 * rng.normal(), 0.05 * rng.normal()}));
  BundleOptions solve;
  solve.max_iterations = 300;
  solve.relative_tolerance = 1e-14;
  BothSolvers both(w.problem, solve);
  for (int pose = 0; pose < 8; ++pose) {
    for (int plane = 0; plane < 4; ++plane) {
      const Se3& t = w.true_poses[static_cast<std::size_t>(pose)];
      const double wrong = rng.uniform() < wrong_share ? 0.1 : 0;
      both.observe(pose, plane,
                   sighting(truth[static_cast<std::size_t>(plane)], t,
                            {rng.normal(), rng.normal(), 2 + rng.uniform()}, wrong, rng));
    }
  }
  both.hold_parallel(0, 1, {0.01, 2});
  both.hold_perpendicular(0, 2, {0.01, 1});
  for (int wall = 0; wall < 3; ++wall) both.hold_perpendicular(wall, 3, {});
  both.know(3, {truth[3].retract({0.01, -0.01, 0.01}), information});
  const double cost = both.oracle().solve();
  const SolveReport report = solve_bundle(w.problem, solve);
  EXPECT_TRUE(report.converged);
  EXPECT_NEAR(report.final_cost, cost, 1e-6 * cost);
  for (std::size_t i = 0; i < w.problem.poses.size(); ++i)
    EXPECT_LT((both.oracle().pose(i).inverse() * w.problem.poses[i]).log().norm(), 1e-5) << "pose " << i;
  for (std::size_t i = 0; i < truth.size(); ++i)
    EXPECT_LT(w.problem.structures.planes[i].local(both.plane_of_oracle(i)).norm(), 1e-5) << "plane " << i;
}

TEST(CeresOracle, WindowWithPlanes) { expect_same_structure(300, 21, 0); }

TEST(CeresOracle, PlanesCarryAWindowWithoutLandmarks) { expect_same_structure(0, 22, 0); }

TEST(CeresOracle, WrongSightingsOfPlanes) { expect_same_structure(300, 23, 0.1); }

}  // namespace
}  // namespace vsgraphs
