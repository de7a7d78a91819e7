// Poses, landmarks and markers in Ceres, with its own derivatives and logarithm: both solvers must reach the same optimum.
#include <ceres/rotation.h>

#include "core/base/rng.h"
#include "core/solve/ceres_oracle_test.h"
#include "core/solve/factors/marker_pose.h"
#include "core/solve/synthetic_window_test.h"

namespace vsgraphs {
namespace {

template <typename T>
Vector3<T> cross(const Vector3<T>& a, const Vector3<T>& b) {
  return {a.y() * b.z() - a.z() * b.y(), a.z() * b.x() - a.x() * b.z(), a.x() * b.y() - a.y() * b.x()};
}

// The logarithm by the closed form of the left Jacobian's inverse; angles away from 0 and pi.
struct SeenMarker {
  Se3 seen;
  Matrix6d root;

  template <typename T>
  bool operator()(const T* qa, const T* ta, const T* qb, const T* tb, T* residual) const {
    using Quaternion = Eigen::Quaternion<T>;
    const Quaternion pose(Eigen::Map<const Quaternion>{qa}), marker(Eigen::Map<const Quaternion>{qb});
    const Vector3<T> pose_at(Eigen::Map<const Vector3<T>>{ta}), marker_at(Eigen::Map<const Vector3<T>>{tb});
    const Quaternion seen_turn = Eigen::Quaterniond(seen.rotation()).cast<T>();
    const Quaternion turn = seen_turn.conjugate() * pose.conjugate() * marker;
    const Vector3<T> shift =
        seen_turn.conjugate() *
        Vector3<T>(pose.conjugate() * Vector3<T>(marker_at - pose_at) - seen.translation().cast<T>());
    const T wxyz[4] = {turn.w(), turn.x(), turn.y(), turn.z()};
    Vector3<T> phi;
    ceres::QuaternionToAngleAxis(wxyz, phi.data());
    const T angle = phi.norm();
    const T factor = (T(1) - T(0.5) * angle * (T(1) + cos(angle)) / sin(angle)) / (angle * angle);
    const Vector3<T> turned = cross<T>(phi, shift);
    Eigen::Matrix<T, 6, 1> error;
    error.template head<3>() = shift - T(0.5) * turned + factor * cross<T>(phi, turned);
    error.template tail<3>() = phi;
    Eigen::Map<Eigen::Matrix<T, 6, 1>>{residual} = root.cast<T>() * error;
    return true;
  }
};

void expect_same_markers(int landmarks, std::uint64_t seed, double wrong_share) {
  SyntheticWindowOptions options;
  options.fixed_poses = 2;
  options.free_poses = 6;
  options.landmarks = landmarks;
  SyntheticWindow w = synthetic_window(options, seed);
  Rng rng(seed, "ceres_marker_test", 0);
  std::vector<Se3> truth;
  for (int m = 0; m < 3; ++m) truth.push_back(Se3::exp(random_tangent(rng, 1, 0.5)));
  for (const Se3& m : truth)
    w.problem.structures.markers.push_back(m.retract(random_tangent(rng, 0.1, 0.05)));
  BundleOptions solve;
  solve.max_iterations = 300;
  solve.relative_tolerance = 1e-14;
  CeresBundle oracle(w.problem, solve);
  std::vector<PoseParameters> markers(truth.size());
  for (std::size_t m = 0; m < truth.size(); ++m) {
    const Se3& start = w.problem.structures.markers[m];
    Eigen::Map<Eigen::Vector4d>(markers[m].q.data()) = start.quaternion().coeffs();
    Eigen::Map<Eigen::Vector3d>(markers[m].t.data()) = start.translation();
    oracle.problem().AddParameterBlock(markers[m].q.data(), 4, new ceres::EigenQuaternionManifold);
  }
  Matrix6d root = Eigen::Matrix<double, 6, 1>(80, 90, 40, 30, 30, 60).asDiagonal();
  root(0, 3) = 20, root(2, 5) = -15;
  for (int pose = 0; pose < 8; ++pose) {
    for (int m = 0; m < 3; ++m) {
      const double wrong = rng.uniform() < wrong_share ? 0.2 : 0;
      const Se3 seen = w.true_poses[static_cast<std::size_t>(pose)].inverse() *
                       truth[static_cast<std::size_t>(m)] *
                       Se3::exp(random_tangent(rng, 0.015 + wrong, 0.02 + wrong));
      auto ours = std::make_unique<MarkerPose>(pose, m, seen, root);
      PoseParameters& a = oracle.parameters(pose);
      PoseParameters& b = markers[static_cast<std::size_t>(m)];
      oracle.problem().AddResidualBlock(
          new ceres::AutoDiffCostFunction<SeenMarker, 6, 4, 3, 4, 3>(new SeenMarker{seen, root}),
          CeresBundle::loss_of(ours->robust()), a.q.data(), a.t.data(), b.q.data(), b.t.data());
      w.problem.factors.push_back(std::move(ours));
    }
  }
  const double cost = oracle.solve();
  const SolveReport report = solve_bundle(w.problem, solve);
  EXPECT_TRUE(report.converged);
  EXPECT_NEAR(report.final_cost, cost, 1e-6 * cost);
  for (std::size_t i = 0; i < w.problem.poses.size(); ++i)
    EXPECT_LT((oracle.pose(i).inverse() * w.problem.poses[i]).log().norm(), 1e-5) << "pose " << i;
  for (std::size_t m = 0; m < truth.size(); ++m) {
    const Se3 theirs = Se3::from_quaternion(Eigen::Map<const Eigen::Quaterniond>(markers[m].q.data()),
                                            Eigen::Map<const Eigen::Vector3d>(markers[m].t.data()));
    EXPECT_LT((theirs.inverse() * w.problem.structures.markers[m]).log().norm(), 1e-5) << "marker " << m;
  }
}

TEST(CeresOracle, WindowWithMarkers) { expect_same_markers(300, 31, 0); }

TEST(CeresOracle, MarkersCarryAWindowWithoutLandmarks) { expect_same_markers(0, 32, 0); }

TEST(CeresOracle, WrongSightsOfMarkers) { expect_same_markers(300, 33, 0.1); }

}  // namespace
}  // namespace vsgraphs
