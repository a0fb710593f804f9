/* A ball for the tests of model exchange, of FMI 2.0 and 3.0: h' = v, v' = f - g; it bounces at h = 0, `kick` changes
 * its speed where it changes, `ticks` counts the events at 0.3 s, 0.6 s ...; `scaled` is an array of `n` numbers. */

#include <stdbool.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

enum { H, V, DER_H, DER_V, F, KICK, E, G, BOUNCES, TICKS, COMPLETED, N, WEIGHTS, SCALED, CELSIUS };
enum { MAX = 4 };

typedef struct {
  double h, v, f, kick, kicked, e, g, t, next, w[MAX], celsius;
  int32_t bounces, ticks, completed, event_mode, started;
  uint64_t n;
} Ball;

static void *make(const char *token) {
  if (strcmp(token, "{ball}") != 0) return NULL;
  Ball *b = calloc(1, sizeof(Ball));
  *b = (Ball){.h = 1.0, .e = 0.5, .g = 9.81, .next = 0.3, .n = 2, .w = {1, 1, 1, 1}, .celsius = 20.0};
  return b;
}

static int get_one(Ball *b, uint32_t vr, double *x) {
  switch (vr) {
    case H: *x = 100.0 * b->h; return 1;
    case V: case DER_H: *x = b->v; return 1;
    case DER_V: *x = b->f - b->g; return 1;
    case F: *x = b->f; return 1;
    case KICK: *x = b->kick; return 1;
    case E: *x = b->e; return 1;
    case G: *x = b->g; return 1;
    case CELSIUS: *x = b->celsius; return 1;
    case WEIGHTS: memcpy(x, b->w, b->n * sizeof(double)); return (int)b->n;
    case SCALED: for (uint64_t k = 0; k < b->n; k++) x[k] = b->w[k] * (double)(k + 1); return (int)b->n;
    default: return 0;
  }
}

static int get(Ball *b, const uint32_t *vr, size_t n, double *x) {
  for (size_t k = 0; k < n; k++) {
    int m = get_one(b, vr[k], x);
    if (m == 0) return 3;
    x += m;
  }
  return 0;
}

static int set(Ball *b, const uint32_t *vr, size_t n, const double *x) {
  for (size_t k = 0; k < n; k++) {
    switch (vr[k]) {
      case F: b->f = *x++; break;
      case KICK: if (b->started && !b->event_mode) return 3; b->kick = *x++; break;
      case E: b->e = *x++; break;
      case CELSIUS: b->celsius = *x++; break;
      case WEIGHTS: memcpy(b->w, x, b->n * sizeof(double)); x += b->n; break;
      default: return 3;
    }
  }
  return 0;
}

static int get_integers(Ball *b, const uint32_t *vr, size_t n, int32_t *x) {
  for (size_t k = 0; k < n; k++) {
    switch (vr[k]) {
      case BOUNCES: x[k] = b->bounces; break;
      case TICKS: x[k] = b->ticks; break;
      case COMPLETED: x[k] = b->completed; break;
      default: return 3;
    }
  }
  return 0;
}

/* one thing at a time, so that the iteration has to go on */
static bool update(Ball *b) {
  if (b->h <= 0.0 && b->v < 0.0) { b->h = 1e-300; b->v *= -b->e; b->bounces++; return true; }
  if (b->kick != b->kicked) { b->v += b->kick - b->kicked; b->kicked = b->kick; return true; }
  if (b->t >= b->next - 1e-9) { b->ticks++; b->next = 0.3 * (b->ticks + 1); return true; }
  return false;
}

static int derivative(const uint32_t *u, size_t n_u, const uint32_t *k, size_t n_k, const double *seed, double *x) {
  for (size_t i = 0; i < n_u; i++) {
    x[i] = 0.0;
    for (size_t j = 0; j < n_k; j++) {
      if (u[i] == H && k[j] == H) x[i] += 100.0 * seed[j];
      if ((u[i] == V || u[i] == DER_H) && k[j] == V) x[i] += seed[j];
      if (u[i] == DER_V && k[j] == F) x[i] += seed[j];
    }
  }
  return 0;
}

static int copy_to(Ball *b, void **state) {
  if (*state == NULL) *state = malloc(sizeof(Ball));
  memcpy(*state, b, sizeof(Ball));
  return 0;
}

typedef struct { int needs, ends, nominals, values, has_next; double next; } Events;

const char *fmi2GetVersion(void) { return "2.0"; }
void *fmi2Instantiate(const char *name, int kind, const char *token, const char *r, const void *f, int v, int l) {
  return kind == 0 ? make(token) : NULL;
}
void fmi2FreeInstance(void *c) { free(c); }
int fmi2SetupExperiment(void *c, int d, double tol, double t, int s, double e) { ((Ball *)c)->t = t; return 0; }
int fmi2EnterInitializationMode(void *c) { return 0; }
int fmi2ExitInitializationMode(void *c) { ((Ball *)c)->started = ((Ball *)c)->event_mode = 1; return 0; }
int fmi2Terminate(void *c) { return 0; }
int fmi2Reset(void *c) { return 0; }
int fmi2GetReal(void *c, const uint32_t *vr, size_t n, double *x) { return get(c, vr, n, x); }
int fmi2SetReal(void *c, const uint32_t *vr, size_t n, const double *x) { return set(c, vr, n, x); }
int fmi2GetInteger(void *c, const uint32_t *vr, size_t n, int32_t *x) { return get_integers(c, vr, n, x); }
int fmi2EnterEventMode(void *c) { ((Ball *)c)->event_mode = 1; return 0; }
int fmi2EnterContinuousTimeMode(void *c) { ((Ball *)c)->event_mode = 0; return 0; }
int fmi2NewDiscreteStates(void *c, Events *e) {
  *e = (Events){.needs = update(c), .has_next = 1, .next = ((Ball *)c)->next};
  return 0;
}
int fmi2CompletedIntegratorStep(void *c, int no, int *enter, int *ends) {
  ((Ball *)c)->completed++;
  *enter = *ends = 0;
  return 0;
}
int fmi2SetTime(void *c, double t) { ((Ball *)c)->t = t; return 0; }
int fmi2SetContinuousStates(void *c, const double *x, size_t n) { Ball *b = c; b->h = x[0]; b->v = x[1]; return n == 2 ? 0 : 3; }
int fmi2GetContinuousStates(void *c, double *x, size_t n) { Ball *b = c; x[0] = b->h; x[1] = b->v; return n == 2 ? 0 : 3; }
int fmi2GetNominalsOfContinuousStates(void *c, double *x, size_t n) { x[0] = 1.0; x[1] = 8.0; return 0; }
int fmi2GetDerivatives(void *c, double *x, size_t n) { Ball *b = c; x[0] = b->v; x[1] = b->f - b->g; return n == 2 ? 0 : 3; }
int fmi2GetEventIndicators(void *c, double *x, size_t n) { x[0] = ((Ball *)c)->h; return n == 1 ? 0 : 3; }
int fmi2GetDirectionalDerivative(void *c, const uint32_t *u, size_t n_u, const uint32_t *k, size_t n_k, const double *s, double *x) {
  return derivative(u, n_u, k, n_k, s, x);
}
int fmi2GetFMUstate(void *c, void **state) { return copy_to(c, state); }
int fmi2SetFMUstate(void *c, void *state) { memcpy(c, state, sizeof(Ball)); return 0; }
int fmi2FreeFMUstate(void *c, void **state) { free(*state); *state = NULL; return 0; }
int fmi2SerializedFMUstateSize(void *c, void *state, size_t *n) { *n = sizeof(Ball); return 0; }
int fmi2SerializeFMUstate(void *c, void *state, char *x, size_t n) { memcpy(x, state, n); return 0; }
int fmi2DeSerializeFMUstate(void *c, const char *x, size_t n, void **state) {
  if (n != sizeof(Ball)) return 3;
  *state = malloc(n);
  memcpy(*state, x, n);
  return 0;
}

const char *fmi3GetVersion(void) { return "3.0"; }
void *fmi3InstantiateModelExchange(const char *n, const char *token, const char *r, bool v, bool l, void *env, void *log) {
  return make(token);
}
void fmi3FreeInstance(void *c) { free(c); }
int fmi3EnterConfigurationMode(void *c) { return 0; }
int fmi3ExitConfigurationMode(void *c) { return 0; }
int fmi3SetUInt64(void *c, const uint32_t *vr, size_t n, const uint64_t *x, size_t m) {
  if (vr[0] != N || *x > MAX) return 3;
  ((Ball *)c)->n = *x;
  return 0;
}
int fmi3EnterInitializationMode(void *c, bool d, double tol, double t, bool s, double e) { ((Ball *)c)->t = t; return 0; }
int fmi3ExitInitializationMode(void *c) { return fmi2ExitInitializationMode(c); }
int fmi3Terminate(void *c) { return 0; }
int fmi3Reset(void *c) { return 0; }
int fmi3GetFloat64(void *c, const uint32_t *vr, size_t n, double *x, size_t m) { return get(c, vr, n, x); }
int fmi3SetFloat64(void *c, const uint32_t *vr, size_t n, const double *x, size_t m) { return set(c, vr, n, x); }
int fmi3GetInt32(void *c, const uint32_t *vr, size_t n, int32_t *x, size_t m) { return get_integers(c, vr, n, x); }
int fmi3EnterEventMode(void *c) { return fmi2EnterEventMode(c); }
int fmi3EnterContinuousTimeMode(void *c) { return fmi2EnterContinuousTimeMode(c); }
int fmi3UpdateDiscreteStates(void *c, bool *needs, bool *ends, bool *nominals, bool *values, bool *has_next, double *next) {
  *needs = update(c);
  *ends = *nominals = *values = false;
  *has_next = true;
  *next = ((Ball *)c)->next;
  return 0;
}
int fmi3CompletedIntegratorStep(void *c, bool no, bool *enter, bool *ends) {
  ((Ball *)c)->completed++;
  *enter = *ends = false;
  return 0;
}
int fmi3SetTime(void *c, double t) { return fmi2SetTime(c, t); }
int fmi3SetContinuousStates(void *c, const double *x, size_t n) { return fmi2SetContinuousStates(c, x, n); }
int fmi3GetContinuousStates(void *c, double *x, size_t n) { return fmi2GetContinuousStates(c, x, n); }
int fmi3GetNominalsOfContinuousStates(void *c, double *x, size_t n) { return fmi2GetNominalsOfContinuousStates(c, x, n); }
int fmi3GetContinuousStateDerivatives(void *c, double *x, size_t n) { return fmi2GetDerivatives(c, x, n); }
int fmi3GetEventIndicators(void *c, double *x, size_t n) { return fmi2GetEventIndicators(c, x, n); }
int fmi3GetFMUState(void *c, void **state) { return copy_to(c, state); }
int fmi3SetFMUState(void *c, void *state) { return fmi2SetFMUstate(c, state); }
int fmi3FreeFMUState(void *c, void **state) { return fmi2FreeFMUstate(c, state); }
int fmi3SerializedFMUStateSize(void *c, void *state, size_t *n) { return fmi2SerializedFMUstateSize(c, state, n); }
int fmi3SerializeFMUState(void *c, void *state, char *x, size_t n) { return fmi2SerializeFMUstate(c, state, x, n); }
int fmi3DeserializeFMUState(void *c, const char *x, size_t n, void **state) { return fmi2DeSerializeFMUstate(c, x, n, state); }
