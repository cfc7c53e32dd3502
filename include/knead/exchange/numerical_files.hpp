#pragma once

#include <Eigen/SparseCore>
#include <array>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "knead/base/error.hpp"
#include "knead/spline/spline.hpp"

// Files for other numerical programs: matrices, and fields on grids of points.

namespace knead {
/// A matrix as Matrix Market's text (NIST, exchange formats, "coordinate real"): entries by
/// columns, counted from 1, 17 significant digits, so that reading gives back the same bits.
/// `symmetric`: the lower triangle alone, and said so; whether the matrix is symmetric is not
/// checked. Cost: linear in the entries.
[[nodiscard]] std::string matrix_market(const Eigen::SparseMatrix<double>& matrix,
                                        bool symmetric = false);

/// A dense matrix, row by row, as a NumPy array (.npy, format 1.0, '<f8', C order): the same bits.
[[nodiscard]] std::string npy(
    const Eigen::Ref<const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>&
        matrix);
/// Whole numbers as a NumPy array of one dimension ('<i8').
[[nodiscard]] std::string npy(std::span<const std::int64_t> numbers);

/// A matrix as `scipy.sparse.load_npz` reads it: a ZIP archive of the arrays format ("csc"), shape,
/// data, indices and indptr, stored without compression. The same matrix gives the same bytes.
/// Errors (input): an archive of 4 GB or more, which this form cannot hold.
[[nodiscard]] Expected<std::string> npz(const Eigen::SparseMatrix<double>& matrix);
/// Numbers at the points of a grid.
struct GridField {
  std::string name;
  int components = 1;
  std::vector<double> values;  ///< point after point
};

/// A surface as a grid of points with fields, (i, j) at row i counts[1] + j.
struct FieldGrid {
  std::string name;
  std::array<int, 2> counts = {0, 0};
  Points points;
  std::vector<GridField> fields;
};

/// The grids as an unstructured grid of quadrilaterals in the XML format of VTK (.vtu, ASCII,
/// version 0.1), which ParaView opens. A field that some grids lack is 0 there, and what is not
/// finite is written as 0: the format has no word for it. Numbers have 9 significant digits.
[[nodiscard]] std::string vtu_text(std::span<const FieldGrid> grids);
}  // namespace knead
