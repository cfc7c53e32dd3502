#pragma once

#include "brep/check/check_report.hpp"
#include "describe/bytes.hpp"
#include "knead/exchange/file_info.hpp"
#include "knead/session/session.hpp"

namespace knead {

/// `check_edges` of a document as it would be saved.
struct CheckQuery {
  using Answer = brep::EdgeCheckReport;
  EdgeCheckRequest check;
  Bytes against;  ///< of an earlier version of the file; empty: none
};
void describe(CheckQuery& q, Fields& fields);

/// Errors: those of saving the document, and of `check_edges`; what is wrong with the bytes of
/// `against`. Cost: that of saving it and of `check_edges`.
[[nodiscard]] Expected<brep::EdgeCheckReport> ask(const Session& session, const CheckQuery& q);

}  // namespace knead
