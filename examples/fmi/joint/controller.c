/* Position controller as an FMU of FMI 2.0 for co-simulation.
 *
 *   u = kp (reference - q) - kd w, at most 24 V
 *
 * It has no memory: at each sample it answers the measurements of that instant. */

#include <stdint.h>
#include <stdlib.h>
#include <string.h>

enum { REFERENCE, POSITION, VELOCITY, VOLTAGE, KP, KD, N };
enum { OK = 0, ERROR = 3 };
static const double LARGEST = 24.0;

typedef struct { double x[N]; } Law;

static double voltage(const Law *l) {
  double u = l->x[KP] * (l->x[REFERENCE] - l->x[POSITION]) - l->x[KD] * l->x[VELOCITY];
  return u > LARGEST ? LARGEST : u < -LARGEST ? -LARGEST : u;
}

const char *fmi2GetTypesPlatform(void) { return "default"; }
const char *fmi2GetVersion(void) { return "2.0"; }
int fmi2SetDebugLogging(void *c, int on, size_t n, const char *const *names) { return OK; }

void *fmi2Instantiate(const char *name, int kind, const char *guid, const char *resources, const void *functions,
                      int visible, int logging) {
  Law *l = kind == 1 && strcmp(guid, "{controller}") == 0 ? calloc(1, sizeof(Law)) : NULL;
  if (l == NULL) return NULL;
  l->x[KP] = 60.0;
  l->x[KD] = 4.0;
  return l;
}

void fmi2FreeInstance(void *c) { free(c); }
int fmi2SetupExperiment(void *c, int tolerance, double t, double start, int stop, double end) { return OK; }
int fmi2EnterInitializationMode(void *c) { return OK; }
int fmi2ExitInitializationMode(void *c) { return OK; }
int fmi2Terminate(void *c) { return OK; }
int fmi2Reset(void *c) { return OK; }

int fmi2GetReal(void *c, const uint32_t *vr, size_t n, double *x) {
  Law *l = c;
  for (size_t k = 0; k < n; k++) {
    if (vr[k] >= N) return ERROR;
    x[k] = vr[k] == VOLTAGE ? voltage(l) : l->x[vr[k]];
  }
  return OK;
}

int fmi2SetReal(void *c, const uint32_t *vr, size_t n, const double *x) {
  for (size_t k = 0; k < n; k++) {
    if (vr[k] >= N || vr[k] == VOLTAGE) return ERROR;
    ((Law *)c)->x[vr[k]] = x[k];
  }
  return OK;
}

int fmi2GetFMUstate(void *c, void **state) {
  if (*state == NULL && (*state = malloc(sizeof(Law))) == NULL) return ERROR;
  memcpy(*state, c, sizeof(Law));
  return OK;
}

int fmi2SetFMUstate(void *c, void *state) { memcpy(c, state, sizeof(Law)); return OK; }
int fmi2FreeFMUstate(void *c, void **state) { free(*state); *state = NULL; return OK; }
int fmi2SerializedFMUstateSize(void *c, void *state, size_t *n) { *n = sizeof(Law); return OK; }
int fmi2SerializeFMUstate(void *c, void *state, char *bytes, size_t n) { memcpy(bytes, state, sizeof(Law)); return OK; }

int fmi2DeSerializeFMUstate(void *c, const char *bytes, size_t n, void **state) {
  if (n != sizeof(Law) || (*state = malloc(n)) == NULL) return ERROR;
  memcpy(*state, bytes, n);
  return OK;
}

int fmi2DoStep(void *c, double t, double h, int no) { return OK; }
int fmi2CancelStep(void *c) { return ERROR; }
