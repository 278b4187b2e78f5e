// The least a simulation can cost: MuJoCo's own step on the same model, nothing around it.
// bare_loop MODEL.xml STEPS REPEATS prints nanoseconds per step.

#include <mujoco/mujoco.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

static double now(void) {
  struct timespec t;
  clock_gettime(CLOCK_MONOTONIC, &t);
  return 1e9 * (double)t.tv_sec + (double)t.tv_nsec;
}

int main(int argc, char** argv) {
  if (argc != 4) {
    fprintf(stderr, "usage: bare_loop MODEL.xml STEPS REPEATS\n");
    return 2;
  }
  char error[1000] = "";
  mjModel* model = mj_loadXML(argv[1], NULL, error, sizeof error);
  if (!model) {
    fprintf(stderr, "%s\n", error);
    return 1;
  }
  mjData* data = mj_makeData(model);
  long steps = atol(argv[2]), repeats = atol(argv[3]);
  double began = now();
  for (long repeat = 0; repeat < repeats; repeat++) {
    mj_resetData(model, data);
    for (long step = 0; step < steps; step++) mj_step(model, data);
  }
  printf("%.3f\n", (now() - began) / ((double)steps * (double)repeats));
  mj_deleteData(data);
  mj_deleteModel(model);
  return 0;
}
