/* A rod that a thermostat heats at one end, as examples/rod.rs, by CVODE with a banded Jacobian.
   Built by  cc -O3 rod.c -o rod -lsundials_cvode -lsundials_nvecserial -lsundials_sunlinsolband
   -lsundials_sunmatrixband -lm. Arguments: cells, relative tolerance, switches. Prints the seconds,
   steps and evaluations that a switch took, and the times of the switches. */
#include <cvode/cvode.h>
#include <nvector/nvector_serial.h>
#include <stdio.h>
#include <stdlib.h>
#include <sunlinsol/sunlinsol_band.h>
#include <sunmatrix/sunmatrix_band.h>
#include <time.h>

struct rod { long n; double left; };

static int flow(realtype t, N_Vector uv, N_Vector dv, void *data) {
    struct rod *rod = data;
    (void)t;
    const double *u = N_VGetArrayPointer(uv);
    double *d = N_VGetArrayPointer(dv);
    long n = rod->n;
    double by = (double)(n + 1) * (double)(n + 1);
    for (long i = 0; i < n; i++) {
        double before = i == 0 ? rod->left : u[i - 1], behind = i + 1 == n ? 0.0 : u[i + 1];
        d[i] = by * (before - 2.0 * u[i] + behind);
    }
    return 0;
}

static int guard(realtype t, N_Vector uv, realtype *g, void *data) {
    struct rod *rod = data;
    (void)t;
    g[0] = N_VGetArrayPointer(uv)[rod->n / 2] - (rod->left > 0.0 ? 0.3 : 0.2);
    return 0;
}

int main(int argc, char **argv) {
    (void)argc;
    struct rod rod = {atol(argv[1]), 1.0};
    double tolerance = atof(argv[2]);
    int switches = atoi(argv[3]);
    SUNContext context;
    SUNContext_Create(NULL, &context);
    N_Vector u = N_VNew_Serial(rod.n, context);
    N_VConst(0.0, u);
    SUNMatrix matrix = SUNBandMatrix(rod.n, 1, 1, context);
    SUNLinearSolver solver = SUNLinSol_Band(u, matrix, context);
    void *cvode = CVodeCreate(CV_BDF, context);
    CVodeInit(cvode, flow, 0.0, u);
    CVodeSStolerances(cvode, tolerance, 1e-3 * tolerance);
    CVodeSetUserData(cvode, &rod);
    CVodeSetLinearSolver(cvode, solver, matrix);
    CVodeSetMaxNumSteps(cvode, 1000000);
    CVodeRootInit(cvode, 1, guard);
    double times[1000], t = 0.0;
    long steps = 0, calls = 0, some;
    struct timespec a, b;
    clock_gettime(CLOCK_MONOTONIC, &a);
    for (int k = 0; k < switches; k++) {
        int flag;
        do flag = CVode(cvode, t + 100.0, u, &t, CV_NORMAL); while (flag == CV_SUCCESS);
        if (flag != CV_ROOT_RETURN) return 1;
        times[k] = t;
        rod.left = 1.0 - rod.left;
        CVodeGetNumSteps(cvode, &some); steps += some;
        CVodeGetNumRhsEvals(cvode, &some); calls += some;
        CVodeReInit(cvode, t, u);
    }
    clock_gettime(CLOCK_MONOTONIC, &b);
    printf("%.17g %ld %ld", (b.tv_sec - a.tv_sec + 1e-9 * (b.tv_nsec - a.tv_nsec)) / switches, steps / switches, calls / switches);
    for (int k = 0; k < switches; k++) printf(" %.17g", times[k]);
    printf("\n");
    return 0;
}
