#include "described_archive.hpp"

namespace knead::archive {

void write(Writer& a, const Type& type, const void* value) {
  switch (type.kind) {
    case Kind::boolean:
      return a.flag(*static_cast<const bool*>(value));
    case Kind::integer:
      return a.integer(*static_cast<const int*>(value));
    case Kind::number:
      return a.number(*static_cast<const double*>(value));
    case Kind::text:
      return a.text(*static_cast<const std::string*>(value));
    case Kind::choice:
      return a.integer(type.value(value));
    case Kind::optional:
      a.flag(type.count(value) > 0);
      break;
    case Kind::list:
      a.count(type.count(value));
      break;
    case Kind::array:
      break;
    case Kind::record:
      for (const Field& field : type.fields) write(a, *field.type, field.of(value));
      return;
    case Kind::variant:
      a.integer(type.value(value));
      return write(a, *type.variants[static_cast<std::size_t>(type.value(value))], type.part(value));
    case Kind::opaque:
      return a.surface(*static_cast<const std::shared_ptr<const Surface>*>(value));
  }
  for (std::size_t k = 0; k < type.count(value); ++k) write(a, *type.element, type.part(value, k));
}

void read(Reader& a, const Type& type, void* value) {
  switch (type.kind) {
    case Kind::boolean:
      return a.flag(*static_cast<bool*>(value));
    case Kind::integer:
      return a.integer(*static_cast<int*>(value));
    case Kind::number:
      return a.number(*static_cast<double*>(value));
    case Kind::text:
      return a.text(*static_cast<std::string*>(value));
    case Kind::choice: {
      int choice = 0;
      a.integer(choice);
      if (type.choice(choice) == nullptr) return a.fail();
      return type.assign(value, choice);
    }
    case Kind::optional: {
      bool there = false;
      a.flag(there);
      type.resize(value, there && !a.bad() ? 1 : 0);
      break;
    }
    case Kind::list:
      type.resize(value, a.length(1));
      break;
    case Kind::array:
      break;
    case Kind::record:
      for (const Field& field : type.fields) read(a, *field.type, field.of(value));
      return;
    case Kind::variant: {
      int k = 0;
      a.integer(k);
      if (k < 0 || k >= static_cast<int>(type.variants.size())) return a.fail();
      type.assign(value, k);
      return read(a, *type.variants[static_cast<std::size_t>(k)], type.at(value, 0));
    }
    case Kind::opaque:
      return a.surface(*static_cast<std::shared_ptr<const Surface>*>(value));
  }
  for (std::size_t k = 0; k < type.count(value) && !a.bad(); ++k) read(a, *type.element, type.at(value, k));
}

}  // namespace knead::archive
