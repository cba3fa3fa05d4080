  // Inside start_edge, with the two cross products free: their sum, which no bit is lost of, and the sign that counts for 0. From the edge's other end both products are the opposite
  // (`cross_product_opposite`; P - Q changes its sign), and with them the sum and, unless it is 0, that sign.
  localparam int unsigned WIDE = N_W + F_W + 1;
  logic signed [WIDE-1:0] whole_x, whole_y, whole_z;
  logic signed [N_W-1:0]  turned_x, turned_y, turned_z;
  assign whole_x = WIDE'($signed(normal[2*N_W +: N_W]));
  assign whole_y = WIDE'($signed(normal[1*N_W +: N_W]));
  assign whole_z = WIDE'($signed(normal[0*N_W +: N_W]));
  assign {turned_x, turned_y, turned_z} = turned;

  logic signed [WIDE-1:0] sum_x, sum_y, sum_z, got_x, got_y, got_z;
  assign sum_x = (whole_x <<< F_W) + WIDE'(turned_x);
  assign sum_y = (whole_y <<< F_W) + WIDE'(turned_y);
  assign sum_z = (whole_z <<< F_W) + WIDE'(turned_z);
  assign got_x = WIDE'(nx);
  assign got_y = WIDE'(ny);
  assign got_z = WIDE'(nz);

  // The same from the other end.
  logic signed [E_W-1:0] back_x, back_y, back_z;
  logic expected, back;
  assign {back_x, back_y, back_z} = {-nx, -ny, -nz};
  assign expected = sum_x != 0 ? sum_x > 0 : sum_y != 0 ? sum_y > 0 : sum_z >= 0;
  assign back     = back_x != 0 ? back_x > 0 : back_y != 0 ? back_y > 0 : back_z >= 0;

  // Products of two differences below 2^32, and of one and a fraction below 2^31, twice.
  localparam logic signed [WIDE-1:0] MOST = (WIDE'(1) << 65) - WIDE'(1);
  localparam logic signed [N_W-1:0]  MOST_TURNED = N_W'(1) << 64;
  always_comb begin
    assume (whole_x <= MOST && whole_x >= -MOST && whole_y <= MOST && whole_y >= -MOST && whole_z <= MOST && whole_z >= -MOST);
    assume (turned_x <= MOST_TURNED && turned_x >= -MOST_TURNED && turned_y <= MOST_TURNED && turned_y >= -MOST_TURNED);
    assume (turned_z <= MOST_TURNED && turned_z >= -MOST_TURNED);
    assert (got_x == sum_x && got_y == sum_y && got_z == sum_z);
    assert (tie_o == expected);
    assert (exact_o == '0 ? tie_o && back : back == !tie_o);
    cover (whole_x == 1 && turned_x < 0 && got_x > 0 && tie_o);
    cover (nx == 0 && ny < 0 && whole_y == 0);
    cover (whole_x == MOST && turned_x == MOST_TURNED);
  end
