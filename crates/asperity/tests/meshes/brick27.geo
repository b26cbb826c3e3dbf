// One skew brick of hexahedra; saved complete it holds the middles of faces and cells.
Point(1) = {0, 0, 0};
Point(2) = {1, 0.1, 0};
Point(3) = {1.2, 1, 0.1};
Point(4) = {0.1, 0.9, 0};
Line(1) = {1, 2};
Line(2) = {2, 3};
Line(3) = {3, 4};
Line(4) = {4, 1};
Curve Loop(1) = {1, 2, 3, 4};
Surface(1) = {1};
Transfinite Curve{1, 2, 3, 4} = 2;
Transfinite Surface{1};
Recombine Surface{1};
brick[] = Extrude {0.2, 0.1, 1} { Surface{1}; Layers{2}; Recombine; };
Physical Volume("brick") = {brick[1]};
Physical Surface("top") = {brick[0]};
