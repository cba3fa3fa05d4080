//! What the words of the tables mean, for the long help of their commands.

/// Of `render`.
pub const RENDER: &str = "\
Words of the table:
  bounding radius     half the diagonal of the model's box; distances are given
                      in it
  level               how often a base triangle is split: 0 is the base mesh, N
                      full resolution; the mean is over the triangles that rays
                      hit
  nodes               groups of child boxes tested (four, of `bvh6` six); LOD
                      tests: is a triangle fine enough for its ray
  line                32 bytes of memory; read counts every time, distinct each
                      line once
  bvh_node, l0_record, split, vertex_data, leaf
                      what a line holds: boxes over triangles, a base triangle,
                      how far the surface is from a triangle, vertices of finer
                      levels, triangles of the BVH
  tuple, radius (box, prism), corner, boundary, inside
                      what a line of a grid holds: where vertices of a primitive
                      are, bounds of its nodes, vertices by where they lie
  scene_node, instance
                      of several models: boxes over the places where they stand,
                      and a place
  RMSE, maximum       differences of the pictures, from 0 to 255; PSNR is the
                      same in dB, more is better
  coverage            pixels that see the model in one picture only
  surface off         distance between the surfaces in pixels, where both
                      pictures see one; null with --json if they do so nowhere";

/// Of `simulate`.
pub const SIMULATE: &str = "\
Words of the table:
  bounding radius     half the diagonal of the model's box; distances are given
                      in it
  L1, L2              the caches: one L1 for each group of cores, one L2 for
                      all, then DRAM
  hits, misses        lines (32 bytes) found in a cache, and asked of the next
                      one; merges: missing, but asked for already
  conflicts           requests that waited because their bank of the cache was
                      busy
  waits, cycles       in a bank's queue; before a full queue; banks without a
                      free miss register; on the crossbar between L1 and L2;
                      each summed over all that waited
  cold, capacity,     misses of the L2 of lines read for the first time; that
  conflict            a fully associative one would have too; that it would not
  busiest set, bank   different lines of a set of the L2, and requests to a bank
                      of DRAM, over the mean of all
  row hits            DRAM requests that found their row open; row misses: none
                      was open; row conflicts: another had to be closed first
  contexts            a place for one ray in flight; the shares say what they
                      waited for
  alone needs         cycles of the frame if only this part took time; the
                      largest limits the frame
  energy              of the frame in uJ (millionths of a joule), or in a unit
                      of the machine's own
  bvh_node, l0_record, split, vertex_data, leaf
                      what a line holds: boxes over triangles, a base triangle,
                      how far the surface is from a triangle, vertices of finer
                      levels, triangles of the BVH
  tuple, radius (box, prism), corner, boundary, inside
                      what a line of a grid holds: where vertices of a primitive
                      are, bounds of its nodes, vertices by where they lie
  scene_node, instance
                      of several models: boxes over the places where they stand,
                      and a place";

/// Of `lines`.
pub const LINES: &str = "\
Words of the table:
  bounding radius     half the diagonal of the model's box; distances are given
                      in it
  line                32 bytes of memory; the table counts the different ones
                      that a frame reads
  LOD, BVH            level of detail, against the full-resolution mesh in
                      boxes whose planes have that many bits
  n a leaf            most triangles in a leaf; before it the leaf's layout, as
                      --leaf-layout of render has it
  of the mesh         over the triangles of the mesh file that the scene was
                      built from, not over the finest level
  best BVH            the fewest lines of any row over the finest level without
                      32-bit boxes; best BVH of the mesh, of any over the mesh
  L0                  nodes over base triangles and their records: what every
                      ray reads first
  mean level          of the triangles that rays hit: 0 is the base mesh, N full
                      resolution";

/// Of `crack`.
pub const CRACK: &str = "\
Words of the table:
  crossing            rays that met the surface at all
  axis-parallel       rays along an axis or in a plane of two
  mixed levels        rays that met triangles of two or more levels
  odd                 rays that crossed a closed surface an odd number of times:
                      a miss or a double hit
  unbalanced          rays that went in and out a different number of times";

/// Of `stability`.
pub const STABILITY: &str = "\
Words of the table:
  balanced            rays that went into a closed surface as often as out
  golden              rays compared with the golden traverser, which computes
                      exactly
  misses, doubles     crossings that are missing, and that are too many
  differ              hits that are not the golden traverser's in every field
  overflows           rays on which a number did not fit its stated width
  t ulp, bary ulp     worst rounding of a hit's distance (steps of 2^-32) and
                      barycentrics (2^-31)
  pixels              worst shift of a hit on the picture of a camera
  breaches            misses, doubles, differences and overflows together: there
                      should be none";

/// Of `paths`.
pub const PATHS: &str = "\
Keys of the description (scenes/*.toml are examples; every colour is linear):
  [picture]           width, height, samples (paths of a pixel), depth (bounces), seed,
                      shadow_rays (lights are asked for light; true), exposure (steps of 2; 0)
  [cones]             how cones spread after a hit: diffuse, glossy, light, curvature
  [[camera]]          name, eye, target, up (0, 1, 0), fov (degrees from bottom to top)
  [[model]]           file (.lod, or a mesh with levels) or generate = { scene, levels, base, seed, roughness, walls, width };
                      material (a name) or materials (names by the model's own numbers);
                      rotate (degrees about x, y, z), scale, translate; or matrix, three rows of four, in place of these;
                      copies = { count = [x, y, z], step = [x, y, z], jitter (parts of a step; 0), turn (an axis, at random
                      about it), least (scale at random down to; 1), seed };
                      moves = { by = [x, y, z], turn (an axis through its own origin), degrees (360) }: from --time 0 to 1
  [material.NAME]     kind = \"diffuse\" (albedo), \"glossy\" (reflectance, roughness, albedo), \"mirror\" (reflectance)
                      or \"glass\" (index of refraction, roughness; 0 is smooth)
  [[light]]           kind = \"point\" (position, intensity), \"area\" (corner, along, across, radiance; shines to along x across)
                      or \"sun\" (direction, which points towards the sun, half_angle in degrees, irradiance)
  [environment]       zenith, horizon, ground (radiance), up
  With --machine, lines of several models have two kinds more: scene_node, boxes over models, and instance, where one stands.

Example: lodray paths scenes/room.toml --compare
";

/// Of `cast`.
pub const CAST: &str = "\
Columns of the rays (an array of float32 or float64, 6, 8, 10, 11 or 12 columns):
  0 to 2              origin, in world units
  3 to 5              direction, of any length but 0
  6, 7                radius of the cone at the origin, and its growth per unit of length (0, 0);
                      a pixel's cone starts at 0 and grows by half the pixel's width at distance 1:
                      the level of detail follows from the cone
  8, 9                nearest and farthest distance that counts (0, inf)
  10                  1: any hit serves; 0: the closest (0)
  11                  number of the earlier ray at whose hit this one starts, -1: none (-1)

A ray that names an earlier one starts exactly at that one's hit, not at the rounded point: it meets
neither the triangle that it leaves nor anything behind it, and sees the surface there as the earlier
ray saw it. Its distances are from there. Its origin in the file is checked: it may differ from the hit
by 2^-20 of (the largest coordinate + the earlier ray's distance) and 16 steps of the model's grid,
which is enough for points in float32. If the earlier ray meets nothing, or the origin lies elsewhere,
cast ends with an error. --follow false starts every ray at its own origin, as simulate does. The
method `reference` cannot follow.

Fields of the hits (a structured array; numpy.load(FILE)['t']); where nothing is met, t is inf,
whole numbers are -1 and all others nan:
  t                   distance from the origin in world units
  tree, level, node   the triangle that is met
  triangle            the finest triangle there: face number of `lodray export`, counted from 0
  barycentrics, finest_barycentrics
                      weights of the corners of either triangle
  point, normal       in world space; the normal is interpolated at full resolution
  front               1: the front face is met, 0: the back
  instance            model that is met, of a description of several; 0 of a scene file";

/// Of `completions`.
pub const COMPLETIONS: &str = "\
For this shell: source <(lodray completions bash)
For all, with bash: lodray completions bash >
~/.local/share/bash-completion/completions/lodray";

/// Of `export`.
pub const EXPORT: &str = "\
Faces are in the order of the scene's triangles: counted from 0, face number
tree * 4^level + node is node `node` of base triangle `tree`. At full resolution
that number is the `triangle` of `lodray cast`.";
