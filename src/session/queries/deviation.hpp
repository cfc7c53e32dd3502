#pragma once

#include "exchange/morph/data_deviation.hpp"
#include "knead/session/session.hpp"
#include "morph_fields.hpp"

namespace knead {

/// `data_deviation` of a document as it would be saved.
struct DeviationQuery {
  using Answer = DataDeviation;
  AskedData data;
  MorphRequest request;  ///< what it says of the data
};
void describe(DeviationQuery& q, Fields& fields);

/// Errors: those of saving the document, and of `data_deviation`; (usage) not one kind of data.
/// Cost: that of saving it and of `data_deviation`.
[[nodiscard]] Expected<DataDeviation> ask(const Session& session, const DeviationQuery& q);

}  // namespace knead
