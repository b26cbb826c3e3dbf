// Three skew bricks that do not touch: one of tetrahedra, one of hexahedra (its base not flat), one of wedges.
Macro Brick
  Point(p + 1) = {x, 0, 0, 2};
  Point(p + 2) = {x + 1, 0.1, 0, 2};
  Point(p + 3) = {x + 1.2, 1, z, 2};
  Point(p + 4) = {x + 0.1, 0.9, 0, 2};
  For i In {1:3}
    Line(p + i) = {p + i, p + i + 1};
  EndFor
  Line(p + 4) = {p + 4, p + 1};
  Curve Loop(p + 1) = {p + 1, p + 2, p + 3, p + 4};
  Surface(p + 1) = {p + 1};
Return
x = 0; z = 0; p = 100; Call Brick;
x = 2; z = 0.1; p = 200; Call Brick;
x = 4; z = 0; p = 300; Call Brick;
tets[] = Extrude {0.2, 0.1, 1} { Surface{101}; };
Transfinite Curve{201, 202, 203, 204} = 2;
Transfinite Surface{201};
Recombine Surface{201};
hexes[] = Extrude {0.2, 0.1, 1} { Surface{201}; Layers{2}; Recombine; };
Transfinite Curve{301, 302, 303, 304} = 2;
Transfinite Surface{301};
wedges[] = Extrude {0.2, 0.1, 1} { Surface{301}; Layers{1}; Recombine; };
Physical Volume("tets") = {tets[1]};
Physical Volume("hexes") = {hexes[1]};
Physical Volume("wedges") = {wedges[1]};
Physical Surface("tops") = {tets[0], hexes[0], wedges[0]};
Physical Surface("flanks") = {tets[2], hexes[2], wedges[2]};
Physical Curve("edge") = {101, 201, 301};
