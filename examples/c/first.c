// One ray at a scene: the first program of docs/c-interface.md.
#include "lodray.h"

#include <math.h>
#include <stdio.h>

int main(int argc, char **argv) {
  LodrayScene *scene = argc > 1 ? lodray_scene_open(argv[1]) : NULL;
  LodrayMethod *method = scene ? lodray_method_new(scene, "lod", "delta=1") : NULL;
  LodrayRay ray = {.origin = {0, 0, 5}, .direction = {0, 0, -1}, .cone = 0.001, .t_max = INFINITY};
  LodrayHit hit;
  if (!method || lodray_method_cast(method, &ray, 1, &hit)) {
    fprintf(stderr, "first: %s\n", argc > 1 ? lodray_last_error() : "name a scene file");
    return 1;
  }
  printf("t %g, triangle %lld, level %d\n", hit.t, (long long)hit.triangle, hit.level);
  lodray_method_end(method);
  lodray_scene_close(scene);
  return 0;
}
