// An L of 400 um with a round hole, in um; second-order cells, written by gmsh 4 with
//   gmsh -2 -order 2 -format msh41 l_with_hole.geo
// and, with -bin, l_with_hole_binary.msh
SetFactory("Built-in");
h = 60;
Point(1) = {0, 0, 0, h};
Point(2) = {400, 0, 0, h};
Point(3) = {400, 200, 0, h};
Point(4) = {200, 200, 0, h};
Point(5) = {200, 400, 0, h};
Point(6) = {0, 400, 0, h};
Point(7) = {100, 100, 0, h};
Point(8) = {150, 100, 0, h};
Point(9) = {100, 150, 0, h};
Point(10) = {50, 100, 0, h};
Point(11) = {100, 50, 0, h};
Line(1) = {1, 2};
Line(2) = {2, 3};
Line(3) = {3, 4};
Line(4) = {4, 5};
Line(5) = {5, 6};
Line(6) = {6, 1};
Circle(7) = {8, 7, 9};
Circle(8) = {9, 7, 10};
Circle(9) = {10, 7, 11};
Circle(10) = {11, 7, 8};
Curve Loop(1) = {1, 2, 3, 4, 5, 6};
Curve Loop(2) = {7, 8, 9, 10};
Plane Surface(1) = {1, 2};
Physical Curve("outer") = {1, 2, 3, 4, 5, 6};
Physical Curve("hole") = {7, 8, 9, 10};
Physical Surface("plate") = {1};
