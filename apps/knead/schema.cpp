#include <fmt/format.h>

#include "cli.hpp"
#include "knead/brep/edge_measures.hpp"
#include "knead/exchange/morph.hpp"
#include "knead/session/command_json.hpp"
#include "say.hpp"

namespace knead::cli {

Action add_schema(CLI::App& app) {
  auto form = std::make_shared<std::string>("script");
  CLI::App* command = app.add_subcommand(
      "schema", "print the JSON schema of scripts, Knead documents, checks or morphs");
  command->add_option("FORM", *form, "script (default), document, check or morph")->type_name("");
  command->footer(std::string(exit_codes));
  return [form]() -> Expected<void> {
    if (*form == "check") {
      say("{}", brep::check_schema());
      return {};
    }
    if (*form == "morph") {
      say("{}", morph_schema());
      return {};
    }
    if (*form != "script" && *form != "document") {
      return usage_error("there is no schema of \"" + *form + "\"", "FORM",
                         "the forms are: script, document, check, morph");
    }
    say("{}", *form == "script" ? script_schema() : document_schema());
    return {};
  };
}

}  // namespace knead::cli
