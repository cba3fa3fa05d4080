`default_nettype none

/// The functions of `include/lodray.h` that a testbench needs, as DPI-C: any simulator that has it links `liblodray_c`. A `chandle` is what C has a pointer for;
/// packed vectors are two-state, word by word as the header says.
package lodray_dpi_pkg;

  import "DPI-C" function string lodray_last_error();

  import "DPI-C" function chandle lodray_scene_open(input string path);
  import "DPI-C" function void lodray_scene_close(input chandle scene);
  import "DPI-C" function chandle lodray_golden_new(input chandle scene);
  import "DPI-C" function void lodray_golden_end(input chandle golden);

  // 0: done; 1 and 0 of the second and third: yes and no; less than 0: lodray_last_error says why not.
  import "DPI-C" function int lodray_scene_config_bits(input chandle scene, output bit [$bits(lod_pkg::scene_config_t)-1:0] bits);
  import "DPI-C" function int lodray_line_bits(input chandle scene, input longint unsigned address, output bit [255:0] bits);
  import "DPI-C" function int lodray_camera_ray_bits(input chandle scene, input real distance, input real delta, input int unsigned width, input int unsigned height,
                                                     input int unsigned x, input int unsigned y, output bit [$bits(lod_pkg::ray_in_t)-1:0] bits);
  import "DPI-C" function int lodray_golden_trace_bits(input chandle golden, input bit [$bits(lod_pkg::ray_in_t)-1:0] in_i,
                                                       output bit [$bits(lod_pkg::hit_out_t)-1:0] out_o);

endpackage

`default_nettype wire
