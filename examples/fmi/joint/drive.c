/* DC motor with a gearbox as an FMU of FMI 2.0 for model exchange.
 *
 *   L di/dt = u - R i - k N w        u voltage [V], i current [A], w velocity of the joint [rad/s]
 *   torque  = k N i                  at the joint [N.m]
 *
 * The current is a continuous state: whoever imports the FMU integrates it. */

#include <stdint.h>
#include <stdlib.h>
#include <string.h>

enum { VOLTAGE, VELOCITY, TORQUE, CURRENT, DER_CURRENT, RESISTANCE, INDUCTANCE, TORQUE_CONSTANT, GEAR_RATIO, N };
enum { OK = 0, ERROR = 3 };

typedef struct { double x[N]; } Drive;
typedef struct { int needs, ends, nominals, values, has_next; double next; } EventInfo;

static double torque(const Drive *d) { return d->x[TORQUE_CONSTANT] * d->x[GEAR_RATIO] * d->x[CURRENT]; }

static double rate(const Drive *d) {
  double back_emf = d->x[TORQUE_CONSTANT] * d->x[GEAR_RATIO] * d->x[VELOCITY];
  return (d->x[VOLTAGE] - d->x[RESISTANCE] * d->x[CURRENT] - back_emf) / d->x[INDUCTANCE];
}

const char *fmi2GetTypesPlatform(void) { return "default"; }
const char *fmi2GetVersion(void) { return "2.0"; }
int fmi2SetDebugLogging(void *c, int on, size_t n, const char *const *names) { return OK; }

void *fmi2Instantiate(const char *name, int kind, const char *guid, const char *resources, const void *functions,
                      int visible, int logging) {
  Drive *d = kind == 0 && strcmp(guid, "{drive}") == 0 ? calloc(1, sizeof(Drive)) : NULL;
  if (d == NULL) return NULL;
  d->x[RESISTANCE] = 1.2;
  d->x[INDUCTANCE] = 0.8e-3;
  d->x[TORQUE_CONSTANT] = 0.05;
  d->x[GEAR_RATIO] = 30.0;
  return d;
}

void fmi2FreeInstance(void *c) { free(c); }
int fmi2SetupExperiment(void *c, int tolerance, double t, double start, int stop, double end) { return OK; }
int fmi2EnterInitializationMode(void *c) { return OK; }
int fmi2ExitInitializationMode(void *c) { return OK; }
int fmi2Terminate(void *c) { return OK; }
int fmi2Reset(void *c) { return OK; }

int fmi2GetReal(void *c, const uint32_t *vr, size_t n, double *x) {
  Drive *d = c;
  for (size_t k = 0; k < n; k++) {
    if (vr[k] >= N) return ERROR;
    x[k] = vr[k] == TORQUE ? torque(d) : vr[k] == DER_CURRENT ? rate(d) : d->x[vr[k]];
  }
  return OK;
}

int fmi2SetReal(void *c, const uint32_t *vr, size_t n, const double *x) {
  for (size_t k = 0; k < n; k++) {
    if (vr[k] >= N || vr[k] == TORQUE || vr[k] == DER_CURRENT) return ERROR;
    ((Drive *)c)->x[vr[k]] = x[k];
  }
  return OK;
}

int fmi2GetFMUstate(void *c, void **state) {
  if (*state == NULL && (*state = malloc(sizeof(Drive))) == NULL) return ERROR;
  memcpy(*state, c, sizeof(Drive));
  return OK;
}

int fmi2SetFMUstate(void *c, void *state) { memcpy(c, state, sizeof(Drive)); return OK; }
int fmi2FreeFMUstate(void *c, void **state) { free(*state); *state = NULL; return OK; }
int fmi2SerializedFMUstateSize(void *c, void *state, size_t *n) { *n = sizeof(Drive); return OK; }
int fmi2SerializeFMUstate(void *c, void *state, char *bytes, size_t n) { memcpy(bytes, state, sizeof(Drive)); return OK; }

int fmi2DeSerializeFMUstate(void *c, const char *bytes, size_t n, void **state) {
  if (n != sizeof(Drive) || (*state = malloc(n)) == NULL) return ERROR;
  memcpy(*state, bytes, n);
  return OK;
}

int fmi2GetDirectionalDerivative(void *c, const uint32_t *unknowns, size_t n_unknowns, const uint32_t *knowns,
                                 size_t n_knowns, const double *seed, double *change) {
  Drive *d = c;
  double kn = d->x[TORQUE_CONSTANT] * d->x[GEAR_RATIO], inductance = d->x[INDUCTANCE];
  for (size_t i = 0; i < n_unknowns; i++) {
    change[i] = 0.0;
    for (size_t k = 0; k < n_knowns; k++) {
      double slope = 0.0;
      if (unknowns[i] == TORQUE && knowns[k] == CURRENT) slope = kn;
      if (unknowns[i] == DER_CURRENT && knowns[k] == VOLTAGE) slope = 1.0 / inductance;
      if (unknowns[i] == DER_CURRENT && knowns[k] == CURRENT) slope = -d->x[RESISTANCE] / inductance;
      if (unknowns[i] == DER_CURRENT && knowns[k] == VELOCITY) slope = -kn / inductance;
      change[i] += slope * seed[k];
    }
  }
  return OK;
}

int fmi2EnterEventMode(void *c) { return OK; }
int fmi2NewDiscreteStates(void *c, EventInfo *info) { memset(info, 0, sizeof(EventInfo)); return OK; }
int fmi2EnterContinuousTimeMode(void *c) { return OK; }
int fmi2CompletedIntegratorStep(void *c, int no, int *event, int *ends) { *event = *ends = 0; return OK; }
int fmi2SetTime(void *c, double t) { return OK; }
int fmi2SetContinuousStates(void *c, const double *x, size_t n) { ((Drive *)c)->x[CURRENT] = x[0]; return OK; }
int fmi2GetContinuousStates(void *c, double *x, size_t n) { x[0] = ((Drive *)c)->x[CURRENT]; return OK; }
int fmi2GetNominalsOfContinuousStates(void *c, double *x, size_t n) { x[0] = 10.0; return OK; }
int fmi2GetDerivatives(void *c, double *x, size_t n) { x[0] = rate(c); return OK; }
int fmi2GetEventIndicators(void *c, double *x, size_t n) { return OK; }
