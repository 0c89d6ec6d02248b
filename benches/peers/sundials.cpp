// SUNDIALS: CVODE (BDF and Adams, Newton or fixed point), ARKODE (explicit and diagonally implicit).
#include "problems.hpp"
#include <arkode/arkode_arkstep.h>
#include <arkode/arkode_erkstep.h>
#include <cvode/cvode.h>
#include <nvector/nvector_serial.h>
#include <string>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <sunnonlinsol/sunnonlinsol_fixedpoint.h>

static SUNContext context;
static constexpr long STEPS = 5'000'000;

template <class P> struct Data { P problem; long rhs = 0, jacobians = 0; };

template <class P> int rhs(sunrealtype t, N_Vector y, N_Vector f, void *user) {
  auto &data = *static_cast<Data<P> *>(user);
  ++data.rhs;
  data.problem.rhs(t, NV_DATA_S(y), NV_DATA_S(f));
  return 0;
}
template <class P> int jacobian(sunrealtype t, N_Vector y, N_Vector, SUNMatrix out, void *user, N_Vector, N_Vector, N_Vector) {
  auto &data = *static_cast<Data<P> *>(user);
  ++data.jacobians;
  double j[P::N][P::N];
  data.problem.jacobian(t, NV_DATA_S(y), j);
  for (int r = 0; r < P::N; ++r) for (int c = 0; c < P::N; ++c) SM_ELEMENT_D(out, r, c) = j[r][c];
  return 0;
}
template <class P> int guards(sunrealtype t, N_Vector y, sunrealtype *g, void *user) {
  static_cast<Data<P> *>(user)->problem.guards(t, NV_DATA_S(y), g);
  return 0;
}

template <class P> struct Vectors {
  N_Vector y = N_VNew_Serial(P::N, context), absolute = N_VNew_Serial(P::N, context);
  SUNMatrix matrix = SUNDenseMatrix(P::N, P::N, context);
  SUNLinearSolver linear = SUNLinSol_Dense(y, matrix, context);
  explicit Vectors(double tolerance) { for (int i = 0; i < P::N; ++i) NV_Ith_S(absolute, i) = tolerance * P::SCALES[i]; }
  ~Vectors() { SUNLinSolFree(linear); SUNMatDestroy(matrix); N_VDestroy(absolute); N_VDestroy(y); }
};

// Runs a solver given by how it restarts, advances and counts.
template <class P, class Restart, class Advance, class Steps, class Roots>
void drive(Run &run, Data<P> &data, double tolerance, N_Vector y, int root_found, Restart restart, Advance advance, Steps steps, Roots roots) {
  data.rhs = data.jacobians = 0;
  data.problem.start(NV_DATA_S(y), tolerance);
  restart(0.0);
  for (;;) {
    const int flag = advance(&run.time);
    long count = 0;
    steps(&count);
    run.steps += count;
    if (flag < 0) run.status = flag;
    if (flag != root_found) break;
    run.events.push_back(run.time);
    int found[P::GUARDS];
    roots(found);
    const int which = std::find_if(found, found + P::GUARDS, [](int f) { return f != 0; }) - found;
    if (data.problem.event(run.time, NV_DATA_S(y), which) || run.runaway()) break;
    restart(run.time);
  }
  run.rhs = data.rhs;
  run.jacobians = data.jacobians;
  run.y.assign(NV_DATA_S(y), NV_DATA_S(y) + P::N);
}

template <class P> void cvode(double tolerance, int family, bool newton) {
  Data<P> data;
  Vectors<P> v(tolerance);
  data.problem.start(NV_DATA_S(v.y), tolerance);
  void *solver = CVodeCreate(family, context);
  CVodeInit(solver, rhs<P>, 0, v.y);
  CVodeSVtolerances(solver, tolerance, v.absolute);
  CVodeSetUserData(solver, &data);
  CVodeSetMaxNumSteps(solver, STEPS);
  SUNNonlinearSolver fixed = nullptr;
  if (newton) {
    CVodeSetLinearSolver(solver, v.linear, v.matrix);
    CVodeSetJacFn(solver, jacobian<P>);
  } else {
    fixed = SUNNonlinSol_FixedPoint(v.y, 0, context);
    CVodeSetNonlinearSolver(solver, fixed);
  }
  int falling[P::GUARDS];
  std::fill(falling, falling + P::GUARDS, -1);
  CVodeRootInit(solver, P::GUARDS, guards<P>);
  CVodeSetRootDirection(solver, falling);
  CVodeSetNoInactiveRootWarn(solver);
  const std::string method = std::string(family == CV_BDF ? "BDF" : "Adams") + (newton ? " Newton" : " fixed point");
  measure("CVODE", method.c_str(), P::NAME, tolerance, [&](Run &run) {
    drive(run, data, tolerance, v.y, CV_ROOT_RETURN,
          [&](double t) { CVodeReInit(solver, t, v.y); CVodeSetStopTime(solver, P::END); },
          [&](double *t) { return CVode(solver, P::END, v.y, t, CV_NORMAL); },
          [&](long *n) { CVodeGetNumSteps(solver, n); },
          [&](int *found) { CVodeGetRootInfo(solver, found); });
  });
  CVodeFree(&solver);
  if (fixed) SUNNonlinSolFree(fixed);
}

template <class P> void explicit_pair(double tolerance, int order) {
  Data<P> data;
  Vectors<P> v(tolerance);
  data.problem.start(NV_DATA_S(v.y), tolerance);
  void *solver = ERKStepCreate(rhs<P>, 0, v.y, context);
  ARKodeSVtolerances(solver, tolerance, v.absolute);
  ARKodeSetUserData(solver, &data);
  ARKodeSetMaxNumSteps(solver, STEPS);
  ARKodeSetOrder(solver, order);
  int falling[P::GUARDS];
  std::fill(falling, falling + P::GUARDS, -1);
  ARKodeRootInit(solver, P::GUARDS, guards<P>);
  ARKodeSetRootDirection(solver, falling);
  ARKodeSetNoInactiveRootWarn(solver);
  const std::string method = "ERK " + std::to_string(order);
  measure("ARKODE", method.c_str(), P::NAME, tolerance, [&](Run &run) {
    drive(run, data, tolerance, v.y, ARK_ROOT_RETURN,
          [&](double t) { ERKStepReInit(solver, rhs<P>, t, v.y); ARKodeSetStopTime(solver, P::END); },
          [&](double *t) { return ARKodeEvolve(solver, P::END, v.y, t, ARK_NORMAL); },
          [&](long *n) { ARKodeGetNumSteps(solver, n); },
          [&](int *found) { ARKodeGetRootInfo(solver, found); });
  });
  ARKodeFree(&solver);
}

template <class P> void diagonally_implicit(double tolerance, int order) {
  Data<P> data;
  Vectors<P> v(tolerance);
  data.problem.start(NV_DATA_S(v.y), tolerance);
  void *solver = ARKStepCreate(nullptr, rhs<P>, 0, v.y, context);
  ARKodeSVtolerances(solver, tolerance, v.absolute);
  ARKodeSetUserData(solver, &data);
  ARKodeSetMaxNumSteps(solver, STEPS);
  ARKodeSetOrder(solver, order);
  ARKodeSetLinearSolver(solver, v.linear, v.matrix);
  ARKodeSetJacFn(solver, jacobian<P>);
  int falling[P::GUARDS];
  std::fill(falling, falling + P::GUARDS, -1);
  ARKodeRootInit(solver, P::GUARDS, guards<P>);
  ARKodeSetRootDirection(solver, falling);
  ARKodeSetNoInactiveRootWarn(solver);
  const std::string method = "DIRK " + std::to_string(order);
  measure("ARKODE", method.c_str(), P::NAME, tolerance, [&](Run &run) {
    drive(run, data, tolerance, v.y, ARK_ROOT_RETURN,
          [&](double t) { ARKStepReInit(solver, nullptr, rhs<P>, t, v.y); ARKodeSetStopTime(solver, P::END); },
          [&](double *t) { return ARKodeEvolve(solver, P::END, v.y, t, ARK_NORMAL); },
          [&](long *n) { ARKodeGetNumSteps(solver, n); },
          [&](int *found) { ARKodeGetRootInfo(solver, found); });
  });
  ARKodeFree(&solver);
}

int main(int count, char **names) {
  SUNContext_Create(SUN_COMM_NULL, &context);
  // Failures are in the status of a row.
  SUNContext_ClearErrHandlers(context);
  SUNLogger logger;
  SUNContext_GetLogger(context, &logger);
  SUNLogger_SetErrorFilename(logger, "/dev/null");
  SUNLogger_SetWarningFilename(logger, "/dev/null");
  each(count, names, []<class P>(double tolerance) {
    cvode<P>(tolerance, CV_BDF, true);
    if constexpr (std::string_view(P::NAME) == "P4S") {
      diagonally_implicit<P>(tolerance, 3);
      diagonally_implicit<P>(tolerance, 5);
    } else {
      cvode<P>(tolerance, CV_ADAMS, false);
      explicit_pair<P>(tolerance, 5);
      explicit_pair<P>(tolerance, 8);
    }
  });
  SUNContext_Free(&context);
}
