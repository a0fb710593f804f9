/* A small FMU for the tests of the import, of FMI 2.0 and 3.0: y is the sum of h u, z is gain u. */

#include <stdbool.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

typedef struct { double u, y, gain, t; int started; } Plant;

static void *make(const char *token) {
  if (strcmp(token, "{plant}") != 0) return NULL;
  Plant *p = calloc(1, sizeof(Plant));
  p->gain = 1.0;
  return p;
}

static int get(Plant *p, const uint32_t *vr, size_t n, double *x) {
  for (size_t k = 0; k < n; k++) {
    switch (vr[k]) {
      case 0: x[k] = p->u; break;
      case 1: x[k] = p->y; break;
      case 2: x[k] = p->gain * p->u; break;
      case 3: x[k] = p->gain; break;
      default: return 3;
    }
  }
  return 0;
}

static int set(Plant *p, const uint32_t *vr, size_t n, const double *x) {
  for (size_t k = 0; k < n; k++) {
    if (vr[k] == 0) p->u = x[k];
    else if (vr[k] == 3 && !p->started) p->gain = x[k];
    else return 3;
  }
  return 0;
}

static int step(Plant *p, double t, double h) {
  if (!p->started || t - p->t > 1e-9 || p->t - t > 1e-9) return 3;
  if (p->u > 1000.0) *(volatile int *)NULL = 1;
  if (p->u > 100.0) return 3;
  p->y += h * p->u;
  p->t = t + h;
  return 0;
}

const char *fmi2GetVersion(void) { return "2.0"; }
int fmi2SetDebugLogging(void *c, int on, size_t n, const char *const *names) { return 0; }
void *fmi2Instantiate(const char *name, int kind, const char *token, const char *resources, const void *f, int v, int l) {
  return kind == 1 && strncmp(resources, "file:///", 8) == 0 && f ? make(token) : NULL;
}
void fmi2FreeInstance(void *c) { free(c); }
int fmi2SetupExperiment(void *c, int d, double tol, double t, int s, double e) { ((Plant *)c)->t = t; return 0; }
int fmi2EnterInitializationMode(void *c) { return 0; }
int fmi2ExitInitializationMode(void *c) { ((Plant *)c)->started = 1; return 0; }
int fmi2Terminate(void *c) { return 0; }
int fmi2Reset(void *c) { return 0; }
int fmi2GetReal(void *c, const uint32_t *vr, size_t n, double *x) { return get(c, vr, n, x); }
int fmi2SetReal(void *c, const uint32_t *vr, size_t n, const double *x) { return set(c, vr, n, x); }
int fmi2DoStep(void *c, double t, double h, int no) { return step(c, t, h); }

const char *fmi3GetVersion(void) { return "3.0"; }
int fmi3SetDebugLogging(void *c, bool on, size_t n, const char *const *names) { return 0; }
void *fmi3InstantiateCoSimulation(const char *name, const char *token, const char *resources, bool v, bool l, bool e,
                                  bool r, const uint32_t *iv, size_t n, void *env, void *log, void *update) {
  return resources[0] == '/' ? make(token) : NULL;
}
void fmi3FreeInstance(void *c) { free(c); }
int fmi3EnterInitializationMode(void *c, bool d, double tol, double t, bool s, double e) { ((Plant *)c)->t = t; return 0; }
int fmi3ExitInitializationMode(void *c) { ((Plant *)c)->started = 1; return 0; }
int fmi3Terminate(void *c) { return 0; }
int fmi3Reset(void *c) { return 0; }
int fmi3GetFloat64(void *c, const uint32_t *vr, size_t n, double *x, size_t m) { return get(c, vr, n, x); }
int fmi3SetFloat64(void *c, const uint32_t *vr, size_t n, const double *x, size_t m) { return set(c, vr, n, x); }
int fmi3DoStep(void *c, double t, double h, bool no, bool *event, bool *end, bool *early, double *last) {
  *event = *end = *early = false;
  *last = t + h;
  return step(c, t, h);
}
