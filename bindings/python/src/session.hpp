#pragma once

#include <limits>

#include "binding.hpp"
#include "session/session_state.hpp"
#include "working.hpp"

namespace knead::python {

/// A session for any number of threads, one at a time. Everything that takes time is done without
/// the interpreter.
class PySession {
 public:
  PySession(std::shared_ptr<const Source> source, Session session);

  [[nodiscard]] static std::unique_ptr<PySession> open(const py::bytes& bytes,
                                                       const std::string& name,
                                                       std::size_t max_unpacked);
  [[nodiscard]] static std::unique_ptr<PySession> fresh(const std::string& name,
                                                        const std::string& unit);
  /// Everything, to be kept elsewhere: the file's bytes or None, the snapshot, the commands that
  /// cannot be undone, name and unit.
  [[nodiscard]] py::tuple state();
  [[nodiscard]] static std::unique_ptr<PySession> from_state(const py::tuple& state);
  /// An independent one, of the same file.
  [[nodiscard]] std::unique_ptr<PySession> copy();

  void execute(const std::string& json, py::object progress);
  /// A script, or a list of commands: all of them, or none where one fails. Where it is stopped,
  /// what was done stands.
  void run(const std::string& text, const std::string& name, bool list, py::object progress);

  /// (kind, id, label, unit) of every shape.
  [[nodiscard]] py::list shapes();
  /// None: there is none of that id.
  [[nodiscard]] py::object shape(const std::string& id, bool opened);
  /// The id of the first selected shape; empty: none.
  [[nodiscard]] std::string selected();
  [[nodiscard]] std::string name();
  [[nodiscard]] std::string script();
  [[nodiscard]] std::string info();
  /// What the program says of a file, with the shapes as they are now.
  [[nodiscard]] std::string text();
  [[nodiscard]] std::string report();
  /// The answer of a query of the document (session/queries) as JSON; the files of its request lie
  /// one after the other in `bytes`.
  [[nodiscard]] py::tuple ask(const std::string& query, const std::string& request,
                              const py::bytes& bytes);
  /// (bytes, what they leave out) of a file of that name; without a name the document's own file.
  /// Triangles, which lose the surfaces, only if they may be too.
  [[nodiscard]] py::tuple file(const std::string& name, double tolerance, int detail,
                               const std::string& schema, bool triangles_too);
  /// (grids, reactions, modes, buckling).
  [[nodiscard]] py::tuple analysis(int samples);
  /// Of the first selected surface; without a word on the units in those of the document.
  [[nodiscard]] py::tuple matrices(std::optional<bool> normalised, double tolerance);

 private:
  static constexpr std::size_t unlimited = std::numeric_limits<std::size_t>::max();

  /// Does this while no other thread uses the session; it must not touch Python.
  template <class Act>
  auto alone(Act&& act) {
    const OneAtATime::Taken taken(turn_);
    return act();
  }
  [[nodiscard]] Expected<Session> restored(const std::string& snapshot, std::size_t opening) const;

  std::shared_ptr<const Source> source_;  ///< as opened; null: a fresh document
  Session session_;
  OneAtATime turn_;
};

}  // namespace knead::python
