#pragma once

#include <functional>
#include <vector>

#include "apps/viewer/parts/part.h"
#include "apps/viewer/tools/dropped_files.h"

namespace terrella {

/// Asks what to do with a file that says it is of another body than the globe. Owns the panel. thread: main
class BodyQuestion : public Panel {
 public:
  /// Effects of the answers.
  struct Calls {
    /// The files become layers of that body. False if the window stays with its globe.
    std::function<bool(const Body&, std::vector<SourceOptions>)> open_globe;
    std::function<void(SourceOptions)> add_here;  ///< the file becomes a layer here
  };
  BodyQuestion(const ViewerContext& context, Calls calls) : Panel(context, "Another body"), calls_(std::move(calls)) {}

  /// Asks about a file after the questions that wait. A file of a body that is asked about joins that question.
  void ask(OtherBodyFile file);

 private:
  void draw_open(float foot) override;
  void toggled() override;
  void answer_here();
  void answer_globe();

  Calls calls_;
  std::vector<std::vector<OtherBodyFile>> waiting_;  ///< a question each: files of one body
};

}  // namespace terrella
