// The benchmark problems, and how a C++ peer runs and prints them; see README.md.
//
// A problem is a hybrid automaton whose modes have guards, of which P1 … P5 have one each. An event is a
// guard falling through zero; `event` applies its jump and returns whether the run ends there.
#pragma once
#include "tank.hpp"
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string_view>
#include <vector>

constexpr double GRAVITY = 9.81;
constexpr double TAU = 6.283185307179586476925287;

inline double sign(double x) { return x < 0 ? -1.0 : 1.0; }

// P1, P2: Housner's rocking block, free and on shaken ground; y = (angle, rate).
template <bool SHAKEN> struct RockingBlock {
  static constexpr const char *NAME = SHAKEN ? "P2" : "P1";
  static constexpr int N = 2, GUARDS = 1;
  static constexpr double END = SHAKEN ? 10.0 : 6.0;
  static constexpr std::array<double, N> SCALES{0.2, 0.5};
  static constexpr double ALPHA = 0.25, P_SQUARED = 3 * GRAVITY / (4 * 1.5);
  static constexpr double RESTITUTION = SHAKEN ? 0.85 : 0.9;
  double side;

  void start(double *y, double) { side = 1; y[0] = (SHAKEN ? 0.3 : 0.6) * ALPHA; y[1] = 0; }
  static double ground(double t) { return SHAKEN ? 0.35 * std::sin(1.5 * TAU * t + 0.3) : 0.0; }
  void rhs(double t, const double *y, double *f) const {
    const double angle = ALPHA * side - y[0];
    f[0] = y[1];
    f[1] = -P_SQUARED * (std::sin(angle) + (SHAKEN ? ground(t) * std::cos(angle) : 0.0));
  }
  void jacobian(double t, const double *y, double (*j)[N]) const {
    const double angle = ALPHA * side - y[0];
    j[0][0] = 0; j[0][1] = 1; j[1][1] = 0;
    j[1][0] = P_SQUARED * (std::cos(angle) - (SHAKEN ? ground(t) * std::sin(angle) : 0.0));
  }
  void guards(double, const double *y, double *g) const { *g = side * y[0]; }
  bool event(double, double *y, int) { y[0] = 0; y[1] *= RESTITUTION; side = -side; return false; }
};

// P3b: stick-slip on a belt; y = (x, v); slip is the sign of belt - v, 0 where the mass sticks.
struct Belt {
  static constexpr const char *NAME = "P3b";
  static constexpr int N = 2, GUARDS = 1;
  static constexpr double END = 20;
  static constexpr std::array<double, N> SCALES{0.05, 0.9};
  static constexpr double K = 400, C = 0.1, BELT = 0.2, STATIC = 0.4 * GRAVITY, KINETIC = 0.25 * GRAVITY;
  double slip;

  void start(double *y, double) { slip = 1; y[0] = 0.05; y[1] = 0; }
  static double spring(const double *y) { return K * y[0] + C * y[1]; }
  void rhs(double, const double *y, double *f) const {
    f[0] = y[1];
    f[1] = slip == 0 ? 0 : slip * KINETIC - spring(y);
  }
  void jacobian(double, const double *, double (*j)[N]) const {
    j[0][0] = 0; j[0][1] = 1;
    j[1][0] = slip == 0 ? 0 : -K; j[1][1] = slip == 0 ? 0 : -C;
  }
  void guards(double, const double *y, double *g) const {
    *g = slip == 0 ? STATIC - std::fabs(spring(y)) : slip * (BELT - y[1]);
  }
  bool event(double, double *y, int) {
    y[1] = BELT;
    const double force = spring(y);
    slip = slip != 0 && std::fabs(force) <= STATIC ? 0 : sign(force);
    return false;
  }
};

// P4, P4S: an oscillator on a base that slips, y = (u, d, u', d'); STIFF: k and c times 10^4.
template <bool STIFF> struct Sliding {
  static constexpr const char *NAME = STIFF ? "P4S" : "P4";
  static constexpr int N = 4, GUARDS = 1;
  static constexpr double END = 2;
  static constexpr std::array<double, N> SCALES{0.02, STIFF ? 8e-8 : 1e-3, 0.9, STIFF ? 3.5e-6 : 0.1};
  static constexpr double BASE = 5, UPPER = 39.33, FACTOR = STIFF ? 1e4 : 1, K = 1.05e6 * FACTOR, C = 642 * FACTOR;
  static constexpr double WEIGHT = (BASE + UPPER) * GRAVITY, STATIC = 0.2 * WEIGHT, KINETIC = 0.19 * WEIGHT;
  double slip;

  void start(double *y, double) { slip = 0; std::fill(y, y + N, 0.0); }
  static double ground(double t) { return 20 * std::sin(7 * TAU * t); }
  static double spring(const double *y) { return K * y[1] + C * y[3]; }
  static double held(double t, const double *y) { return spring(y) - BASE * ground(t); }
  void rhs(double t, const double *y, double *f) const {
    const double base = slip == 0 ? 0 : (spring(y) - slip * KINETIC) / BASE - ground(t);
    f[0] = slip == 0 ? 0 : y[2];
    f[1] = y[3];
    f[2] = base;
    f[3] = -spring(y) / UPPER - ground(t) - base;
  }
  void jacobian(double, const double *, double (*j)[N]) const {
    for (int r = 0; r < N; ++r) std::fill(j[r], j[r] + N, 0.0);
    const double base = slip == 0 ? 0 : 1 / BASE;
    j[0][2] = slip == 0 ? 0 : 1; j[1][3] = 1;
    j[2][1] = K * base; j[2][3] = C * base;
    j[3][1] = -K * (1 / UPPER + base); j[3][3] = -C * (1 / UPPER + base);
  }
  void guards(double t, const double *y, double *g) const { *g = slip == 0 ? STATIC - std::fabs(held(t, y)) : slip * y[2]; }
  bool event(double t, double *y, int) {
    const double force = held(t, y);
    const bool sticks = slip != 0 && std::fabs(force) <= STATIC;
    if (slip != 0) y[2] = 0;
    slip = sticks ? 0 : sign(force);
    return false;
  }
};

// P5: a bouncing ball up to its 30th impact; y = (height, velocity).
struct Ball {
  static constexpr const char *NAME = "P5";
  static constexpr int N = 2, GUARDS = 1;
  static constexpr double END = 100;
  static constexpr std::array<double, N> SCALES{1, 4.4};
  int impacts;

  void start(double *y, double) { impacts = 0; y[0] = 1; y[1] = 0; }
  void rhs(double, const double *y, double *f) const { f[0] = y[1]; f[1] = -GRAVITY; }
  void jacobian(double, const double *, double (*j)[N]) const { j[0][0] = 0; j[0][1] = 1; j[1][0] = 0; j[1][1] = 0; }
  void guards(double, const double *y, double *g) const { *g = y[0]; }
  bool event(double, double *y, int) { y[0] = 0; y[1] *= -0.8; return ++impacts == 30; }
};

struct Run {
  std::vector<double> y, events;
  long rhs = 0, jacobians = 0, steps = 0;
  int status = 0;
  double time = 0;
  // A run with more events than any problem has does not end by itself.
  bool runaway() { if (events.size() > 1000) status = -1000; return status != 0; }
};

// Whether a trial was asked for: few tolerances and repeats.
inline bool quick() { return std::getenv("PEERS_QUICK") != nullptr; }

template <class Work> void measure(const char *peer, const char *method, const char *problem, double tolerance, Work work) {
  using Clock = std::chrono::steady_clock;
  auto seconds = [](auto from) { return std::chrono::duration<double>(Clock::now() - from).count(); };
  Run run;
  std::vector<double> times;
  for (const auto begin = Clock::now(); times.size() < (quick() ? 3 : 10) || seconds(begin) < (quick() ? 0 : 0.08);) {
    run = Run();
    const auto start = Clock::now();
    work(run);
    times.push_back(seconds(start));
    if (times[0] > 0.2 || run.status) break;
  }
  std::sort(times.begin(), times.end());
  std::printf("%s|%s|%s|%g|%e|%e|%zu|%ld|%ld|%ld|%d|%.17g|", peer, method, problem, tolerance, times[0], times[times.size() / 2], times.size(),
              run.rhs, run.jacobians, run.steps, run.status, run.time);
  for (size_t i = 0; i < run.y.size(); ++i) std::printf("%s%.17g", i ? ";" : "", run.y[i]);
  std::printf("|");
  for (size_t i = 0; i < run.events.size(); ++i) std::printf("%s%.17g", i ? ";" : "", run.events[i]);
  std::printf("\n");
  std::fflush(stdout);
}

// Calls visit.operator()<Problem>(tolerance) for the named problems, all if none is named.
template <class Visit> void each(int count, char **names, Visit visit) {
  auto one = [&]<class P>() {
    if (count > 1 && std::none_of(names + 1, names + count, [](const char *n) { return std::string_view(n) == P::NAME; })) return;
    for (int digits = 3; digits <= 13; digits += quick() ? 3 : 1) visit.template operator()<P>(std::pow(10.0, -digits));
  };
  one.template operator()<RockingBlock<false>>();
  one.template operator()<RockingBlock<true>>();
  one.template operator()<Belt>();
  one.template operator()<Sliding<false>>();
  one.template operator()<Sliding<true>>();
  one.template operator()<Ball>();
  one.template operator()<Tank<true>>();
  one.template operator()<Tank<false>>();
}
