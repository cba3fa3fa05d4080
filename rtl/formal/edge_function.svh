  // Inside edge_function, with the normal free: the sign that counts for 0, and that it is the opposite from the edge's other end, which has the opposite normal.
  logic signed [N_W-1:0] back_x, back_y, back_z;
  logic expected, back, along_back;
  assign {back_x, back_y, back_z} = {-nx, -ny, -nz};
  assign along_back = px != qx ? px > qx : py != qy ? py > qy : pz >= qz;
  assign expected = nx != 0 ? nx > 0 : ny != 0 ? ny > 0 : nz != 0 ? nz > 0 : qx != px ? qx > px : qy != py ? qy > py : qz >= pz;
  assign back     = back_x != 0 ? back_x > 0 : back_y != 0 ? back_y > 0 : back_z != 0 ? back_z > 0 : along_back;

  localparam logic signed [N_W-1:0] LEAST = {1'b1, {(N_W-1){1'b0}}};
  always_comb begin
    // Products are below 2^64 in magnitude, so that their differences are far from the least number of 66 bits; a point has no normal with itself.
    assume (nx != LEAST && ny != LEAST && nz != LEAST);
    assume (p_i != q_i || normal == '0);
    assert (tie_o == expected);
    assert (p_i == q_i ? tie_o && back : back == !tie_o);
    cover (p_i != q_i && normal == '0 && !tie_o);
    cover (nx == 0 && ny == 0 && nz < 0);
  end

