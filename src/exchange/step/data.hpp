#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "exchange/part21/part21.hpp"
#include "file.hpp"
#include "model.hpp"

namespace knead::step {

/// The data of a `File`.
struct File::Data {
  explicit Data(Part21File parsed) : records(std::move(parsed)) {}

  Part21File records;
  std::string schema;
  std::shared_ptr<const brep::Model> model;
  ModelRecords of;  // what its surfaces and curves were read from
};

}  // namespace knead::step
