/* An FMU of FMI 3.0 with clocks, for co-simulation and model exchange.
 *
 * Clock `sample` ticks every 30 ms from 15 ms on: it takes the input u into s, and x' = s. With every second tick it sets
 * the countdown clock `later`, which ticks 4 ms after it. The output clock `full` ticks with every third tick of both. */

#include <stdbool.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

enum { U, S, X, DER_X, SAMPLES, LATERS, FULLS, SAMPLE = 100, LATER, FULL, CALCULATED };

typedef struct {
  double u, s, x, t;
  int32_t samples, laters, fulls;
  bool is_event, ticks_sample, ticks_later, is_full, has_interval, is_exchange;
} Model;

static void *make(const char *token, bool is_exchange) {
  if (strcmp(token, "{clocks}") != 0) return NULL;
  Model *m = calloc(1, sizeof(Model));
  m->is_exchange = is_exchange;
  return m;
}

const char *fmi3GetVersion(void) { return "3.0"; }
void *fmi3InstantiateCoSimulation(const char *name, const char *token, const char *resources, bool v, bool l,
                                  bool has_event_mode, bool early, const uint32_t *iv, size_t n, void *env, void *log,
                                  void *update) {
  return has_event_mode ? make(token, false) : NULL;
}
void *fmi3InstantiateModelExchange(const char *n, const char *token, const char *r, bool v, bool l, void *env, void *log) {
  return make(token, true);
}
void fmi3FreeInstance(void *c) { free(c); }
int fmi3EnterInitializationMode(void *c, bool d, double tol, double t, bool s, double e) { ((Model *)c)->t = t; return 0; }
int fmi3ExitInitializationMode(void *c) { ((Model *)c)->is_event = true; return 0; }
int fmi3EnterEventMode(void *c) { ((Model *)c)->is_event = true; return 0; }
int fmi3EnterStepMode(void *c) { ((Model *)c)->is_event = false; return 0; }
int fmi3EnterContinuousTimeMode(void *c) { ((Model *)c)->is_event = false; return 0; }
int fmi3Terminate(void *c) { return 0; }
int fmi3Reset(void *c) { return 0; }

int fmi3GetFloat64(void *c, const uint32_t *vr, size_t n, double *x, size_t m) {
  Model *of = c;
  for (size_t k = 0; k < n; k++) {
    switch (vr[k]) {
      case U: x[k] = of->u; break;
      case S: case DER_X: x[k] = of->s; break;
      case X: x[k] = of->x; break;
      default: return 3;
    }
  }
  return 0;
}
int fmi3SetFloat64(void *c, const uint32_t *vr, size_t n, const double *x, size_t m) {
  for (size_t k = 0; k < n; k++) {
    if (vr[k] != U) return 3;
    ((Model *)c)->u = x[k];
  }
  return 0;
}
int fmi3GetInt32(void *c, const uint32_t *vr, size_t n, int32_t *x, size_t m) {
  Model *of = c;
  for (size_t k = 0; k < n; k++) {
    switch (vr[k]) {
      case SAMPLES: x[k] = of->samples; break;
      case LATERS: x[k] = of->laters; break;
      case FULLS: x[k] = of->fulls; break;
      default: return 3;
    }
  }
  return 0;
}

/* clocks tick in event mode alone, and are inactive again after it */
int fmi3SetClock(void *c, const uint32_t *vr, size_t n, const bool *x) {
  Model *of = c;
  if (!of->is_event) return 3;
  for (size_t k = 0; k < n; k++) {
    if (vr[k] == SAMPLE) of->ticks_sample = x[k];
    else if (vr[k] == LATER) of->ticks_later = x[k];
    else return 3;
  }
  return 0;
}
int fmi3GetClock(void *c, const uint32_t *vr, size_t n, bool *x) {
  Model *of = c;
  if (n != 1 || vr[0] != FULL || !of->is_event) return 3;
  x[0] = of->is_full;
  return 0;
}
int fmi3GetIntervalDecimal(void *c, const uint32_t *vr, size_t n, double *interval, int *qualifier) {
  Model *of = c;
  if (n != 1 || vr[0] != LATER) return 3;
  interval[0] = 0.004;
  qualifier[0] = of->has_interval ? 2 : of->samples > 1 ? 1 : 0;
  of->has_interval = false;
  return 0;
}
int fmi3UpdateDiscreteStates(void *c, bool *needs, bool *ends, bool *nominals, bool *values, bool *has_next, double *next) {
  Model *m = c;
  if (!m->is_event) return 3;
  *needs = *ends = *nominals = *values = *has_next = false;
  *next = 0.0;
  if (m->ticks_sample) {
    m->s = m->u;
    m->samples++;
    m->has_interval = m->samples % 2 == 0;
  }
  if (m->ticks_later) m->laters++;
  if (m->ticks_sample || m->ticks_later) {
    m->is_full = (m->samples + m->laters) % 3 == 0;
    m->fulls += m->is_full;
  }
  m->ticks_sample = m->ticks_later = false;
  return 0;
}

int fmi3DoStep(void *c, double t, double h, bool no, bool *event, bool *end, bool *early, double *last) {
  Model *m = c;
  if (m->is_event || m->is_exchange || t - m->t > 1e-9 || m->t - t > 1e-9) return 3;
  m->x += h * m->s;
  m->t = t + h;
  *event = *end = *early = false;
  *last = m->t;
  return 0;
}

int fmi3CompletedIntegratorStep(void *c, bool no, bool *enter, bool *ends) { *enter = *ends = false; return 0; }
int fmi3SetTime(void *c, double t) { ((Model *)c)->t = t; return 0; }
int fmi3SetContinuousStates(void *c, const double *x, size_t n) { ((Model *)c)->x = x[0]; return n == 1 ? 0 : 3; }
int fmi3GetContinuousStates(void *c, double *x, size_t n) { x[0] = ((Model *)c)->x; return n == 1 ? 0 : 3; }
int fmi3GetNominalsOfContinuousStates(void *c, double *x, size_t n) { x[0] = 1.0; return 0; }
int fmi3GetContinuousStateDerivatives(void *c, double *x, size_t n) { x[0] = ((Model *)c)->s; return n == 1 ? 0 : 3; }
int fmi3GetEventIndicators(void *c, double *x, size_t n) { return n == 0 ? 0 : 3; }
