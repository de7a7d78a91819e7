// Cost and normal equations of all observations, four of one pose at a time.
#include <algorithm>

#include "core/solve/bundle/landmark_part.h"

#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic ignored "-Wpsabi"  // see lanes.h
#endif

namespace vsgraphs {

inline ProjectionLanes LandmarkPart::project_group(const Group& group, const Se3& pose,
                                                   const std::vector<Eigen::Vector3d>& landmarks) const {
  Lanes x, y, z;
  for (int k = 0; k < lane_count; ++k) {
    const Eigen::Vector3d& point = landmarks[group.landmark[k]];
    x[k] = point.x();
    y[k] = point.y();
    z[k] = point.z();
  }
  return project(k_, pose, x, y, z, group.seen);
}

double LandmarkPart::cost(const std::vector<Se3>& poses,
                          const std::vector<Eigen::Vector3d>& landmarks) const {
  double total = 0;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    Lanes of_pose = {};
    for (int g = group_begin_[i]; g < group_begin_[i + 1]; ++g) {
      of_pose += project_group(groups_[g], poses[i], landmarks).cost;
    }
    total += sum(of_pose);
  }
  return 0.5 * total;
}

// d p_c / d point = R', so a point's block is R M R' and its tie to the pose -[M R'; p x M R'].
void LandmarkPart::add_to_points(const Group& group, const Se3& pose, const ProjectionLanes& q,
                                 const PointInformation& info) {
  Lanes r[3][3];
  for (int i = 0; i < 3; ++i)
    for (int k = 0; k < 3; ++k) r[i][k] = lanes(pose.rotation()(i, k));
  Lanes of_edge[12];  // N = M R' by columns, p
  for (int k = 0; k < 3; ++k) {
    of_edge[3 * k + 0] = info.m00 * r[k][0] + info.m02 * r[k][2];
    of_edge[3 * k + 1] = info.m11 * r[k][1] + info.m12 * r[k][2];
    of_edge[3 * k + 2] = info.m02 * r[k][0] + info.m12 * r[k][1] + info.m22 * r[k][2];
  }
  of_edge[9] = q.px, of_edge[10] = q.py, of_edge[11] = q.pz;
  Lanes of_landmark[12] = {};  // R N lower half, -R g
  int at = 0;
  for (int k = 0; k < 3; ++k) {
    for (int i = k; i < 3; ++i) {
      of_landmark[at++] =
          r[i][0] * of_edge[3 * k] + r[i][1] * of_edge[3 * k + 1] + r[i][2] * of_edge[3 * k + 2];
    }
  }
  for (int i = 0; i < 3; ++i)
    of_landmark[6 + i] = -(r[i][0] * info.g0 + r[i][1] * info.g1 + r[i][2] * info.g2);
  for (int part = 0; part < 12; part += 4) {
    transpose(of_edge + part);
    transpose(of_landmark + part);
  }
  for (int k = 0; k < lane_count && group.source[k] >= 0; ++k) {
    double* landmark = landmarks_[group.landmark[k]].values.data();
    for (int part = 0; part < 12; part += 4)
      store(landmark + part, load(landmark + part) + of_landmark[part + k]);
    if (group.edge[k] < 0) continue;
    // The last three, p, are the same for all observations of an edge.
    double* edge = edges_[group.edge[k]].values.data();
    store(edge, load(edge) + of_edge[k]);
    store(edge + 4, load(edge + 4) + of_edge[4 + k]);
    const double n22 = edge[8];
    store(edge + 8, of_edge[8 + k]);
    edge[8] += n22;
  }
}

void LandmarkPart::linearise(const std::vector<Se3>& poses, const std::vector<Eigen::Vector3d>& landmarks,
                             double* values, Eigen::VectorXd& b) {
  std::fill(landmarks_.begin(), landmarks_.end(), Landmark{});
  std::fill(edges_.begin(), edges_.end(), Edge{});
  for (std::size_t i = 0; i < poses.size(); ++i) {
    PoseSums sums;
    for (int g = group_begin_[i]; g < group_begin_[i + 1]; ++g) {
      const Group& group = groups_[g];
      const ProjectionLanes q = project_group(group, poses[i], landmarks);
      const PointInformation info(k_, group.seen, q);
      sums.add(q, info);
      add_to_points(group, poses[i], q, info);
    }
    const int variable = variable_of_pose_[i];
    if (variable >= 0)
      sums.add_to(Eigen::Map<Matrix6d>(values + diagonal_value_[variable]), b.data() + 6 * variable);
  }
}

}  // namespace vsgraphs
