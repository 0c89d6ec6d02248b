// The walking tank (models/walking_tank) as a problem of the peers, by its generated functions.
//
// y = (uplift angle, bulging displacement, slip of the base, and their rates). What a mode holds stands
// still in y, so that all modes have the same size.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>
#include <limits>
#include <utility>

// What a generated function sees besides the free coordinates: signals, their rates, discrete states, all
// coordinates, constants, jerks; and where it keeps sines and cosines.
struct Angle { double angle = 0, sin = 0, cos = 1; };
struct Context { const double *u, *u_dot, *d, *h, *c, *j; Angle *angles; };
using Function = void(const double *q, const double *v, const double *a, const Context *x, double *out);

struct Transition {
  int target;
  Function *reset, *condition;
  int conditions;
  bool impact;
};
struct Guard {
  Function *value;
  bool accelerations;  // whether it depends on them
  Transition transitions[2];
};
struct Mode {
  int free, coordinates[3];
  Function *system, *jacobian;
  int rest;  // the mode after infinitely many impacts, −1 if there are none
  Guard guards[4];
};
#include "tank_tables.hpp"

// The scenes tank_free_release.json and tank_full_plate.json.
template <bool FREE> struct Tank {
  static constexpr const char *NAME = FREE ? "free" : "plate";
  static constexpr int COUNT = 3, N = 2 * COUNT, GUARDS = 4;
  static constexpr double END = FREE ? 0.5 : 2.0;
  static constexpr std::array<double, N> SCALES{0.01, 1e-3, 0.01, 0.1, 0.1, 0.1};
  int mode;
  double least_rate, last_rate, discrete[DISCRETES], constants[CONSTANTS];
  mutable Angle angles[ANGLES];

  Tank() {
    const Context context{nullptr, nullptr, nullptr, nullptr, nullptr, nullptr, angles};
    CONSTANTS_OF(PARAMETERS, nullptr, nullptr, &context, constants);
  }

  void start(double *y, double tolerance) {
    std::fill(y, y + N, 0.0);
    if (FREE) y[0] = 0.02;
    mode = FREE ? ROCKS_STICKS : STANDS_STICKS;
    discrete[0] = discrete[1] = 1;
    least_rate = tolerance * SCALES[COUNT];
    last_rate = std::numeric_limits<double>::infinity();
  }
  void rhs(double t, const double *y, double *f) const {
    const State s(*this, MODES[mode], t, y);
    double a[COUNT];
    s.accelerations(a);
    std::fill(f, f + N, 0.0);
    for (int i = 0; i < s.mode.free; ++i) {
      f[s.mode.coordinates[i]] = s.v[i];
      f[COUNT + s.mode.coordinates[i]] = a[i];
    }
  }
  // From the residual r(a, v, q) = 0: ∂a/∂v = −(∂r/∂a)⁻¹ ∂r/∂v, and the same for q.
  void jacobian(double t, const double *y, double (*j)[N]) const {
    const State s(*this, MODES[mode], t, y);
    const int n = s.mode.free, *at = s.mode.coordinates;
    double a[COUNT], r[3 * COUNT * COUNT];
    s.accelerations(a);
    s.call(s.mode.jacobian, a, r);
    for (int row = 0; row < N; ++row) std::fill(j[row], j[row] + N, 0.0);
    for (int i = 0; i < n; ++i) j[at[i]][COUNT + at[i]] = 1;
    for (int column = 0; column < n; ++column) {
      for (int part : {1, 2}) {
        double mass[COUNT * COUNT], x[COUNT];
        std::copy(r, r + n * n, mass);
        std::copy(r + (part * n + column) * n, r + (part * n + column + 1) * n, x);
        solve(n, mass, x);
        for (int i = 0; i < n; ++i) j[COUNT + at[i]][(part == 1 ? COUNT : 0) + at[column]] = -x[i];
      }
    }
  }
  // A guard that the mode does not have is 1.
  void guards(double t, const double *y, double *g) const {
    const State s(*this, MODES[mode], t, y);
    double a[COUNT];
    if (std::any_of(s.mode.guards, s.mode.guards + GUARDS, [](const Guard &guard) { return guard.accelerations; })) s.accelerations(a);
    for (int i = 0; i < GUARDS; ++i) {
      g[i] = 1;
      if (s.mode.guards[i].value) s.call(s.mode.guards[i].value, a, g + i);
    }
  }
  // Takes the transition of a guard, and those of the guards that are negative after it.
  bool event(double t, double *y, int which) {
    double g[GUARDS];
    do {
      fire(t, y, which);
      guards(t, y, g);
      which = std::find_if(g, g + GUARDS, [](double value) { return value < 0; }) - g;
    } while (which < GUARDS);
    return false;
  }

 private:
  // The state of the free coordinates of a mode.
  struct State {
    const Mode &mode;
    double q[COUNT], v[COUNT], held[COORDINATES] = {}, signals[SIGNALS] = {};
    Context context;

    // Of the motion of the ground the equations contain the acceleration alone.
    State(const Tank &tank, const Mode &mode, double t, const double *y) : mode(mode) {
      if (!FREE) signals[0] = 20 * std::sin(7 * 6.283185307179586476925287 * t);
      std::copy(y, y + COUNT, held);
      for (int i = 0; i < mode.free; ++i) {
        q[i] = y[mode.coordinates[i]];
        v[i] = y[COUNT + mode.coordinates[i]];
      }
      context = {signals, nullptr, tank.discrete, held, tank.constants, nullptr, tank.angles};
    }
    void call(Function *function, const double *a, double *out) const { function(q, v, a, &context, out); }
    // Of M a + b = 0.
    void accelerations(double *a) const {
      double system[COUNT * COUNT + COUNT];
      call(mode.system, nullptr, system);
      const double *load = system + mode.free * mode.free;
      for (int i = 0; i < mode.free; ++i) a[i] = -load[i];
      solve(mode.free, system, a);
    }
  };

  // Gaussian elimination with row pivots; the matrix is in columns and is overwritten.
  static void solve(int n, double *m, double *x) {
    for (int k = 0; k < n; ++k) {
      int pivot = k;
      for (int i = k + 1; i < n; ++i) if (std::fabs(m[k * n + i]) > std::fabs(m[k * n + pivot])) pivot = i;
      std::swap(x[k], x[pivot]);
      for (int c = k; c < n; ++c) std::swap(m[c * n + k], m[c * n + pivot]);
      for (int i = k + 1; i < n; ++i) {
        const double factor = m[k * n + i] / m[k * n + k];
        for (int c = k + 1; c < n; ++c) m[c * n + i] -= factor * m[c * n + k];
        x[i] -= factor * x[k];
      }
    }
    for (int k = n; k-- > 0;) {
      for (int c = k + 1; c < n; ++c) x[k] -= m[c * n + k] * x[c];
      x[k] /= m[k * n + k];
    }
  }

  // The first transition whose conditions hold after its reset.
  void fire(double t, double *y, int which) {
    const State before(*this, MODES[mode], t, y);
    double a[COUNT], after[2 * COORDINATES + DISCRETES], values[8];
    before.accelerations(a);
    for (const Transition &transition : before.mode.guards[which].transitions) {
      before.call(transition.reset, a, after);
      std::array<double, N> y_after;
      std::copy(after, after + COUNT, y_after.begin());
      std::copy(after + COORDINATES, after + COORDINATES + COUNT, y_after.begin() + COUNT);
      Tank target = *this;
      std::copy(after + 2 * COORDINATES, after + 2 * COORDINATES + DISCRETES, target.discrete);
      const State at_target(target, MODES[transition.target], t, y_after.data());
      if (transition.condition) {
        at_target.accelerations(a);
        at_target.call(transition.condition, a, values);
        if (std::any_of(values, values + transition.conditions, [](double value) { return value < 0; })) { before.accelerations(a); continue; }
      }
      std::copy(y_after.begin(), y_after.end(), y);
      std::copy(target.discrete, target.discrete + DISCRETES, discrete);
      mode = transition.target;
      // Landings accumulate. They end at an uplift rate within its absolute tolerance, and where the solver
      // does not resolve the hops any more: the rate does not shrink.
      if (transition.impact && !(y[COUNT] > least_rate && y[COUNT] < last_rate)) {
        mode = MODES[mode].rest;
        y[0] = y[COUNT] = 0;
      }
      if (transition.impact) last_rate = y[COUNT];
      return;
    }
  }
};
