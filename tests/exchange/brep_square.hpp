#pragma once

#include <string>

namespace knead::testing {

/// A bilinear face over the unit square, put 10 along x, with its triangles; its wire lists the
/// edges out of order.
inline const std::string brep_square =
    "DBRep_DrawableShape\n\nCASCADE Topology V1, (c) Matra-Datavision\nLocations 1\n1\n"
    "1 0 0 10\n0 1 0 0\n0 0 1 0\n"
    "Curve2ds 1\n1 0 0 1 0 \n"
    "Curves 4\n1 0 0 0 1 0 0 \n1 1 0 0 0 1 0 \n8 0 1\n1 1 1 0 -1 0 0 \n1 0 1 0 0 -1 0 \n"
    "Polygon3D 0\nPolygonOnTriangulations 1\n2 1 2 \np 0.1 1 0 1 \n"
    "Surfaces 1\n9 0 0 0 0 1 1 2 2 2 2 0 0 0 0 1 0  1 0 0 1 1 0  \n0 2\n1 2\n\n0 2\n1 2\n\n"
    "Triangulations 1\n4 2 1 0.1\n0 0 0 1 0 0 1 1 0 0 1 0 0 0 1 0 1 1 0 1 1 2 3 1 3 4 \n\n"
    "TShapes 10\n"
    "Ve\n1e-7\n0 0 0\n0 0\n\n0101100\n*\nVe\n1e-7\n1 0 0\n0 0\n\n0101100\n*\n"
    "Ve\n1e-7\n1 1 0\n0 0\n\n0101100\n*\nVe\n1e-7\n0 1 0\n0 0\n\n0101100\n*\n"
    "Ed\n 1e-7 1 1 0\n1  1 0 0 1\n2  1 1 0 0 1\n6  1 1 0\n0\n\n0101000\n+10 0 -9 0 *\n"
    "Ed\n 1e-7 1 1 0\n1  2 0 0 1\n0\n\n0101000\n+9 0 -8 0 *\n"
    "Ed\n 1e-7 1 1 0\n1  3 0 0 1\n0\n\n0101000\n+8 0 -7 0 *\n"
    "Ed\n 1e-7 1 1 0\n1  4 0 0 1\n0\n\n0101000\n+7 0 -10 0 *\n"
    "Wi\n\n0101100\n+6 0 +4 0 +3 0 +5 0 *\n"
    "Fa\n0  1e-7 1 0\n2  1\n0101000\n+2 0 *\n\n+1 1 \n";

}  // namespace knead::testing
