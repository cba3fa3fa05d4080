  // Inside box_test, with products by the operator: the six pairs of planes as they are defined, each written out by its axes from the input, none taken from the block.
  localparam int unsigned WIDE = 64;
  typedef logic signed [WIDE-1:0] wide_t;

  function automatic logic signed [PRODUCT_W-1:0] times(input logic [CODE_W-1:0] code, input logic [D_W-1:0] magnitude);
    logic signed [PRODUCT_W-1:0] a, b;
    a = {{(D_W + 1) {code[CODE_W-1]}}, code};
    b = {{(CODE_W + 1) {1'b0}}, magnitude};
    times = a * b;
  endfunction

  logic [CODE_W-1:0] low_x, low_y, low_z, high_x, high_y, high_z;
  logic signed [CODE_W-1:0] far_x, far_y, far_z;
  logic signed [CEIL_W-1:0] from_x, from_y, from_z;
  logic signed [MOMENT_W-1:0] c_x, c_y, c_z;
  // Codes are at most 2^15 and components below 2^30: products below 2^45 in magnitude, differences below 2^46, which PRODUCT_W bits hold.
  logic signed [PRODUCT_W-1:0] yz, zy, zx, xz, xy, yx;
  logic [5:0] met;
  logic in_front;
  always_comb begin
    low_x = in_i.ray.x.mirror ? -in_i.bounds.hi.x : in_i.bounds.lo.x;
    low_y = in_i.ray.y.mirror ? -in_i.bounds.hi.y : in_i.bounds.lo.y;
    low_z = in_i.ray.z.mirror ? -in_i.bounds.hi.z : in_i.bounds.lo.z;
    high_x = in_i.ray.x.mirror ? -in_i.bounds.lo.x : in_i.bounds.hi.x;
    high_y = in_i.ray.y.mirror ? -in_i.bounds.lo.y : in_i.bounds.hi.y;
    high_z = in_i.ray.z.mirror ? -in_i.bounds.lo.z : in_i.bounds.hi.z;
    {far_x, far_y, far_z} = {high_x, high_y, high_z};
    {from_x, from_y, from_z} = {in_i.ray.x.ceil, in_i.ray.y.ceil, in_i.ray.z.ceil};
    {c_x, c_y, c_z} = {in_i.ray.moment.x, in_i.ray.moment.y, in_i.ray.moment.z};
    in_front = far_x >= from_x && far_y >= from_y && far_z >= from_z;
    // near_i d_j <= far_j d_i: c of a pair's third axis, and its opposite for the pair turned.
    yz = times(low_y, in_i.ray.z.d) - times(high_z, in_i.ray.y.d);
    zy = times(low_z, in_i.ray.y.d) - times(high_y, in_i.ray.z.d);
    zx = times(low_z, in_i.ray.x.d) - times(high_x, in_i.ray.z.d);
    xz = times(low_x, in_i.ray.z.d) - times(high_z, in_i.ray.x.d);
    xy = times(low_x, in_i.ray.y.d) - times(high_y, in_i.ray.x.d);
    yx = times(low_y, in_i.ray.x.d) - times(high_x, in_i.ray.y.d);
    met = {
      wide_t'(yz) <= wide_t'(c_x) >>> lod_pkg::BOX_SHIFT, wide_t'(zy) <= (-wide_t'(c_x)) >>> lod_pkg::BOX_SHIFT,
      wide_t'(zx) <= wide_t'(c_y) >>> lod_pkg::BOX_SHIFT, wide_t'(xz) <= (-wide_t'(c_y)) >>> lod_pkg::BOX_SHIFT,
      wide_t'(xy) <= wide_t'(c_z) >>> lod_pkg::BOX_SHIFT, wide_t'(yx) <= (-wide_t'(c_z)) >>> lod_pkg::BOX_SHIFT
    };
  end

  logic legal;
  always_comb begin
    legal = 1'b1;
    for (int unsigned k = 0; k < 3; k++) begin
      legal = legal && stored_lo[k] != 16'h8000 && stored_hi[k] != 16'h8000 && moment[k] != {1'b1, {(MOMENT_W-1){1'b0}}};
    end
    assume (legal);
    assert (out_o.hit == (met == '1 && in_front && {entry, {lod_pkg::T_NEAR_TO_T_SHIFT{1'b0}}} <= in_i.t_max));
    cover (out_o.hit && mirror == 3'b101);
    for (int unsigned k = 0; k < 6; k++) cover (met == ~(6'd1 << k) && in_front && !out_o.hit);
  end
