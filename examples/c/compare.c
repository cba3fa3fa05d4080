// Every ray of a picture through the cycle model of the traversal unit, and each hit against the golden traverser: what a testbench of another core does.
//
//   compare [--save FILE] [--break RAY] [SCENE.lod [WIDTH [DISTANCE]]]
//
// Without a scene a sphere is generated, which --save writes to a file. --break makes the unit's hit of a ray wrong, to see that it is found. `scripts/c-interface` builds and runs it.
#include "lodray.h"

#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// Cycles from a memory request to its line, and lines on their way at most: two for each of at most 64 contexts, and those of rays that ended early.
enum { LATENCY = 40, LINES = 1024 };
// Cycles without anything moving after which the unit hangs.
enum { PATIENCE = 20000 };
// Full detail would hide the level of detail: a pixel's cone it is.
static const double DELTA = 1.0;

static void fail(const char *what) {
  fprintf(stderr, "compare: %s: %s\n", what, lodray_last_error());
  exit(1);
}

static void *room(size_t count, size_t size) {
  void *all = calloc(count ? count : 1, size);
  if (!all) {
    fprintf(stderr, "compare: out of memory\n");
    exit(1);
  }
  return all;
}

// A memory that answers in order, one line a cycle, each after LATENCY cycles.
struct memory {
  const LodrayScene *scene;
  LodrayMemoryRequest due[LINES];
  uint64_t at[LINES];
  unsigned first, count;
};

static bool memory_has_room(const struct memory *memory) { return memory->count < LINES; }

static void memory_take(struct memory *memory, const LodrayMemoryRequest *request, uint64_t cycle) {
  unsigned place = (memory->first + memory->count++) % LINES;
  memory->due[place] = *request;
  memory->at[place] = cycle + LATENCY;
}

static bool memory_answer(struct memory *memory, uint64_t cycle, LodrayMemoryAnswer *answer) {
  if (memory->count == 0 || memory->at[memory->first] > cycle) return false;
  const LodrayMemoryRequest *request = &memory->due[memory->first];
  answer->tag = request->tag;
  answer->epoch = request->epoch;
  int found = lodray_scene_line(memory->scene, request->address, answer->line);
  if (found < 0) fail("memory");
  answer->error = found == 0;
  memory->first = (memory->first + 1) % LINES;
  memory->count--;
  return true;
}

// Hits are the same if all their bits are.
static bool same(const LodrayHitOut *a, const LodrayHitOut *b) {
  uint32_t bits[2][LODRAY_HIT_OUT_WORDS];
  if (lodray_hit_out_to_bits(a, bits[0]) || lodray_hit_out_to_bits(b, bits[1])) fail("hit");
  return memcmp(bits[0], bits[1], sizeof bits[0]) == 0;
}

static void print(const char *who, const LodrayHitOut *hit) {
  printf("  %s: error %u, found %u, t %llu, tree %u, level %u, node %u, weights %u %u %u\n", who, hit->error, hit->found, (unsigned long long)hit->t, hit->tree,
         hit->level, hit->node, hit->b0, hit->b1, hit->b2);
}

int main(int argc, char **argv) {
  const char *save = NULL;
  unsigned long broken = ~0ul;
  for (; argc > 2 && argv[1][0] == '-'; argc -= 2, argv += 2) {
    if (strcmp(argv[1], "--save") == 0) save = argv[2];
    else if (strcmp(argv[1], "--break") == 0) broken = strtoul(argv[2], NULL, 10);
    else break;
  }
  LodrayScene *scene = argc > 1 ? lodray_scene_open(argv[1]) : lodray_scene_generate("sphere", 3, 32, 0);
  if (!scene || (save && lodray_scene_save(scene, save))) fail("scene");
  int width = argc > 2 ? atoi(argv[2]) : 32;
  double distance = argc > 3 ? atof(argv[3]) : 2.5;
  if (width < 1 || width > 4096) {
    fprintf(stderr, "compare: the width must be 1 to 4096\n");
    return 1;
  }
  uint64_t pixels = (uint64_t)width * (uint64_t)width;

  // What every ray meets, by the definition.
  LodrayRay *rays = room(pixels, sizeof *rays);
  if (lodray_camera_rays(scene, distance, (uint32_t)width, (uint32_t)width, rays)) fail("camera");
  LodrayGolden *golden = lodray_golden_new(scene);
  if (!golden) fail("golden");
  LodrayGoldenHit *wanted = room(pixels, sizeof *wanted);
  if (lodray_golden_cast(golden, rays, pixels, DELTA, wanted)) fail("golden");

  // The same in floats by the program's own traverser.
  LodrayMethod *method = lodray_method_new(scene, "lod", "delta=1");
  if (!method) fail("method");
  LodrayHit *cast = room(pixels, sizeof *cast);
  if (lodray_method_cast(method, rays, pixels, cast)) fail("cast");

  // And as hardware gives it, cycle by cycle.
  LodraySceneConfig config;
  if (lodray_scene_config(scene, &config)) fail("config");
  LodrayUnit *unit = lodray_unit_begin(&config, NULL);
  if (!unit) fail("unit");
  static struct memory memory;
  memory.scene = scene;
  uint64_t cycle = 0, next = 0, sent = 0, done = 0, met = 0, wrong = 0, quiet = 0;
  while (next < pixels || done < sent) {
    while (next < pixels && !wanted[next].entered) next++;
    LodrayOutputs out;
    if (lodray_unit_outputs(unit, &out)) fail("outputs");
    LodrayInputs in = {0};
    in.ready_i = 1;
    in.mem_ready_i = memory_has_room(&memory);
    in.valid_i = next < pixels;
    if (in.valid_i) in.in_i = wanted[next].in_i;
    in.mem_valid_i = memory_answer(&memory, cycle, &in.mem_i);
    quiet++;
    if (in.mem_valid_i) quiet = 0;
    if (in.valid_i && out.ready_o) {
      next++;
      sent++;
    }
    if (out.mem_valid_o && in.mem_ready_i) memory_take(&memory, &out.mem_o, cycle);
    if (out.valid_o) {
      if (out.out_o.tag >= pixels) {
        printf("a hit of no ray: tag %u\n", out.out_o.tag);
        return 1;
      }
      if (out.out_o.tag == broken) out.out_o.t ^= 1;
      const LodrayHitOut *golden_hit = &wanted[out.out_o.tag].out_o;
      if (!same(&out.out_o, golden_hit)) {
        printf("ray %u: the unit is not golden\n", out.out_o.tag);
        print("unit", &out.out_o);
        print("golden", golden_hit);
        wrong++;
      }
      done++;
      quiet = 0;
      met += out.out_o.found;
    }
    if (lodray_unit_step(unit, &in)) fail("step");
    if (quiet > PATIENCE) {
      printf("the unit hangs: nothing moved for %d cycles\n", PATIENCE);
      return 1;
    }
    cycle++;
  }
  for (uint64_t k = 0; k < pixels; k++) {
    const LodrayHit *a = &cast[k], *b = &wanted[k].hit;
    if (a->t != b->t || a->tree != b->tree || a->level != b->level || a->node != b->node || a->triangle != b->triangle) {
      printf("ray %llu: the method lod is not golden: t %.17g and %.17g\n", (unsigned long long)k, a->t, b->t);
      wrong++;
    }
  }
  printf("%llu rays, %llu into the unit, %llu hits, %llu cycles: %llu differ\n", (unsigned long long)pixels, (unsigned long long)sent, (unsigned long long)met,
         (unsigned long long)cycle, (unsigned long long)wrong);

  free(cast);
  free(wanted);
  free(rays);
  lodray_unit_end(unit);
  lodray_method_end(method);
  lodray_golden_end(golden);
  lodray_scene_close(scene);
  return wrong ? 1 : 0;
}
