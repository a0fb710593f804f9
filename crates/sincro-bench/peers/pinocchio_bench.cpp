// Times Pinocchio's ABA, RNEA and a semi-implicit Euler step, through its C++ headers, in double precision.
//
// Compiled and driven by pinocchio_bench.py, which documents the line protocol and writes the tables read here.
// usage: pinocchio_bench TABLE_DIR        (requests on stdin, one JSON line each on stdout)
#include <pinocchio/multibody.hpp>
#include <pinocchio/algorithm/aba.hpp>
#include <pinocchio/algorithm/joint-configuration.hpp>
#include <pinocchio/algorithm/rnea.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <iostream>
#include <map>
#include <memory>
#include <sstream>
#include <stdexcept>
#include <string>
#include <time.h>
#include <vector>

namespace pin = pinocchio;
using Eigen::Vector3d;
using Eigen::VectorXd;

static double seconds_on(clockid_t clock) {
  timespec t;
  clock_gettime(clock, &t);
  return double(t.tv_sec) + 1e-9 * double(t.tv_nsec);
}

struct Timing {
  double median_ns, min_ns, cpu_median_ns, cpu_min_ns;
  int repetitions;
  long calls_per_repetition;
};

static double median(std::vector<double> v) {
  std::sort(v.begin(), v.end());
  return v[v.size() / 2];
}

// Repetitions of about 5 ms each, until `budget` seconds are spent (at least five).
template <class Call>
static Timing measure(double budget, Call call) {
  long n = 1;
  for (;;) {
    double t = seconds_on(CLOCK_MONOTONIC);
    for (long i = 0; i < n; i++) call();
    if (seconds_on(CLOCK_MONOTONIC) - t > 0.005) break;
    n *= 2;
  }
  std::vector<double> wall, cpu;
  const double end = seconds_on(CLOCK_MONOTONIC) + budget;
  do {
    double c = seconds_on(CLOCK_THREAD_CPUTIME_ID), w = seconds_on(CLOCK_MONOTONIC);
    for (long i = 0; i < n; i++) call();
    w = seconds_on(CLOCK_MONOTONIC) - w;
    c = seconds_on(CLOCK_THREAD_CPUTIME_ID) - c;
    wall.push_back(1e9 * w / double(n));
    cpu.push_back(1e9 * c / double(n));
  } while (wall.size() < 5 || seconds_on(CLOCK_MONOTONIC) < end);
  return {median(wall), *std::min_element(wall.begin(), wall.end()), median(cpu), *std::min_element(cpu.begin(), cpu.end()),
          int(wall.size()), n};
}

// One robot: Pinocchio's model, what Pinocchio's model does not hold (springs, dampers, torques, thrusts), its start.
struct Robot {
  pin::Model model;
  std::unique_ptr<pin::Data> data;
  VectorXd q_start, stiffness, rest, damping, torque;
  std::vector<int> hinge_q, hinge_v;                  // indices of each hinge in q and in v
  std::vector<std::string> names;                     // as in the table, one per joint
  std::vector<pin::Force> forces;                     // constant wrench on each joint's body, body axes
  bool has_forces = false;
  pin::Convention convention = pin::Convention::WORLD;  // frame of ABA's recursion; same result, other speed
  VectorXd q, v, tau, accel, dv, q_next;

  explicit Robot(const std::string& path);
  void reset() { q = q_start; v.setZero(); }
  void applied_torques();
  void accelerate();
  void step(double h);
};

// Table: one joint with its body a line; see `table_of` in pinocchio_bench.py for the columns.
Robot::Robot(const std::string& path) {
  std::ifstream file(path);
  if (!file) throw std::runtime_error("no such model");
  struct Row { double k, rest, c, tau, f[3]; std::vector<double> start; bool free; pin::JointIndex joint; };
  std::vector<Row> rows;
  Vector3d gravity;
  std::string word;
  file >> word >> gravity[0] >> gravity[1] >> gravity[2];
  model.gravity.linear(gravity);
  std::string kind, name;
  while (file >> kind >> name) {
    Row r;
    int parent;
    Vector3d axis, position, com;
    double mass, i[6];
    file >> parent >> axis[0] >> axis[1] >> axis[2] >> position[0] >> position[1] >> position[2] >> mass
         >> com[0] >> com[1] >> com[2];
    for (double& x : i) file >> x;
    file >> r.k >> r.rest >> r.c >> r.tau;
    for (double& x : r.f) file >> x;
    r.free = kind == "free";
    r.start.resize(r.free ? 7 : 1);
    for (double& x : r.start) file >> x;
    if (!file) throw std::runtime_error("malformed table at `" + name + "`");

    // the joint types Pinocchio's own URDF reader would choose, but for unbounded hinges (slower: cosine and sine as coordinates)
    const pin::JointIndex p = parent < 0 ? 0 : rows.at(size_t(parent)).joint;
    const pin::SE3 placement(Eigen::Matrix3d::Identity(), position);
    if (r.free) r.joint = model.addJoint(p, pin::JointModelFreeFlyer(), placement, name);
    else if (axis == Vector3d::UnitX()) r.joint = model.addJoint(p, pin::JointModelRX(), placement, name);
    else if (axis == Vector3d::UnitY()) r.joint = model.addJoint(p, pin::JointModelRY(), placement, name);
    else if (axis == Vector3d::UnitZ()) r.joint = model.addJoint(p, pin::JointModelRZ(), placement, name);
    else r.joint = model.addJoint(p, pin::JointModelRevoluteUnaligned(axis.normalized()), placement, name);
    Eigen::Matrix3d inertia;
    inertia << i[0], i[3], i[4], i[3], i[1], i[5], i[4], i[5], i[2];
    model.appendBodyToJoint(r.joint, pin::Inertia(mass, com, inertia));
    rows.push_back(r);
    names.push_back(name);
  }

  data = std::make_unique<pin::Data>(model);
  forces.assign(size_t(model.njoints), pin::Force::Zero());
  q_start = pin::neutral(model);
  stiffness = rest = damping = torque = VectorXd::Zero(model.nv);
  v = tau = accel = dv = VectorXd::Zero(model.nv);
  for (const Row& r : rows) {
    const int iq = model.joints[r.joint].idx_q(), iv = model.joints[r.joint].idx_v();
    forces[r.joint].linear(Vector3d(r.f[0], r.f[1], r.f[2]));
    has_forces |= !forces[r.joint].linear().isZero(0.0);
    if (r.free) {  // table: x y z w x y z; Pinocchio: x y z x y z w
      for (int k = 0; k < 3; k++) { q_start[iq + k] = r.start[size_t(k)]; q_start[iq + 3 + k] = r.start[size_t(k) + 4]; }
      q_start[iq + 6] = r.start[3];
      continue;
    }
    q_start[iq] = r.start[0];
    stiffness[iv] = r.k; rest[iv] = r.rest; damping[iv] = r.c; torque[iv] = r.tau;
    hinge_q.push_back(iq);
    hinge_v.push_back(iv);
  }
  q_next = q_start;
  reset();
}

// τ = u − c v − k (q − rest)
void Robot::applied_torques() {
  tau = torque - damping.cwiseProduct(v);
  for (size_t k = 0; k < hinge_q.size(); k++) tau[hinge_v[k]] -= stiffness[hinge_v[k]] * (q[hinge_q[k]] - rest[hinge_v[k]]);
}

// Forward dynamics with everything the scene holds; result in data->ddq.
void Robot::accelerate() {
  applied_torques();
  if (has_forces) pin::aba(model, *data, q, v, tau, forces, convention);
  else pin::aba(model, *data, q, v, tau, convention);
}

// Semi-implicit Euler on the configuration manifold.
void Robot::step(double h) {
  accelerate();
  v += h * data->ddq;
  dv = h * v;
  pin::integrate(model, q, dv, q_next);
  q.swap(q_next);
}

static void print(const Timing& t, const std::string& rest) {
  std::printf("{\"median_ns\": %.2f, \"min_ns\": %.2f, \"cpu_median_ns\": %.2f, \"cpu_min_ns\": %.2f, "
              "\"repetitions\": %d, \"calls_per_repetition\": %ld%s}\n",
              t.median_ns, t.min_ns, t.cpu_median_ns, t.cpu_min_ns, t.repetitions, t.calls_per_repetition, rest.c_str());
}

// Measures `call` in both of ABA's conventions, and prints the faster.
template <class Call>
static void print_faster(Robot& r, double budget, const std::string& rest, Call call) {
  r.convention = pin::Convention::LOCAL;
  const Timing local = measure(budget / 2, call);
  r.convention = pin::Convention::WORLD;
  const Timing world = measure(budget / 2, call);
  const bool local_wins = local.cpu_median_ns <= world.cpu_median_ns;  // processor time: not disturbed by other programs
  char which[120];
  std::snprintf(which, sizeof which, ", \"convention\": \"%s\", \"other_convention_cpu_median_ns\": %.2f", local_wins ? "local" : "world",
                local_wins ? world.cpu_median_ns : local.cpu_median_ns);
  print(local_wins ? local : world, which + rest);
}

static void forward(Robot& r, double budget) {
  r.reset();
  r.v.setConstant(0.1);
  r.applied_torques();
  volatile double sink = 0;
  print_faster(r, budget, "", [&] { pin::aba(r.model, *r.data, r.q, r.v, r.tau, r.convention); sink = r.data->ddq[0]; });
}

static void inverse(Robot& r, double budget) {
  r.reset();
  r.v.setConstant(0.1);
  r.accel.setConstant(0.1);
  volatile double sink = 0;
  print(measure(budget, [&] { pin::rnea(r.model, *r.data, r.q, r.v, r.accel); sink = r.data->tau[0]; }), "");
}

// Whether `n` steps from the start stay within anything physical.
static bool survives(Robot& r, double h, long n) {
  r.reset();
  for (long i = 0; i < n; i++) r.step(h);
  return r.v.allFinite() && r.v.cwiseAbs().maxCoeff() < 1e6;
}

// Where the step diverges, a tenth of it is timed, and so on: the work is the same, and huge angles make sine and cosine slow.
static void step(Robot& r, double h, double budget) {
  double timed = h;
  long per_reset = 0;
  for (int tries = 0; tries < 6; tries++, timed /= 10) {
    per_reset = std::clamp(std::lround(1.0 / timed), 1L, 1000L);
    if (survives(r, timed, per_reset)) break;
  }
  long n = 0;
  r.reset();
  char rest[80];
  std::snprintf(rest, sizeof rest, ", \"diverged\": %s, \"timed_step\": %g", timed < h ? "true" : "false", timed);
  print_faster(r, budget, rest, [&] {
    r.step(timed);
    if (++n == per_reset) { n = 0; r.reset(); }
  });
}

// Joint accelerations at the start, all hinges moving at 0.3 rad/s: the proof that the models agree.
static void acceleration(Robot& r) {
  r.reset();
  for (int iv : r.hinge_v) r.v[iv] = 0.3;
  r.accelerate();
  std::printf("{\"acceleration\": {");
  for (size_t k = 0; k < r.names.size(); k++) {
    const auto& joint = r.model.joints[r.model.getJointId(r.names[k])];
    std::printf("%s\"%s\": [", k ? ", " : "", r.names[k].c_str());
    for (int i = 0; i < joint.nv(); i++)  // free body: angular first (Pinocchio: linear first)
      std::printf("%s%.17g", i ? ", " : "", r.data->ddq[joint.idx_v() + (joint.nv() == 6 ? (i + 3) % 6 : i)]);
    std::printf("]");
  }
  std::printf("}}\n");
}

int main(int argc, char** argv) {
  if (argc != 2) { std::fprintf(stderr, "usage: pinocchio_bench TABLE_DIR\n"); return 2; }
  std::map<std::string, std::unique_ptr<Robot>> robots;
  std::string line;
  while (std::getline(std::cin, line)) {  // VERB MODEL SECONDS [STEP]
    std::istringstream words(line);
    std::string verb, name;
    double budget = 0.2, h = 0;
    words >> verb >> name >> budget >> h;
    try {
      auto& robot = robots[name];
      if (!robot) robot = std::make_unique<Robot>(std::string(argv[1]) + "/" + name + ".table");
      if (verb == "forward") forward(*robot, budget);
      else if (verb == "inverse") inverse(*robot, budget);
      else if (verb == "step" && h > 0) step(*robot, h, budget);
      else if (verb == "acceleration") acceleration(*robot);
      else throw std::runtime_error("cannot read the request");
    } catch (const std::exception& e) {
      std::printf("{\"error\": \"%s: %s\"}\n", name.c_str(), e.what());
    }
    std::fflush(stdout);
  }
}
