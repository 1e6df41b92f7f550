#pragma once

#include <chrono>
#include <filesystem>
#include <functional>
#include <future>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "apps/flight/flight_file.h"
#include "apps/open_scene/options/scene_options.h"
#include "apps/viewer/flights/film_job.h"
#include "apps/viewer/parts/part.h"
#include "view/navigation.h"

namespace terrella {

/// The functions that a flight needs of the other parts of the viewer.
struct FlightCalls {
  std::function<std::vector<Camera>()> bookmarks;  ///< in the order of their numbers
  std::function<SceneOptions()> scene;             ///< as the window shows it, with the drawings
  std::function<bool()> opening;                   ///< files are being opened, and will be told of
};

/// Plays flights: through the bookmarks, or the tours of opened files; saves them, and has films of them rendered. Owns
/// the panel. A user who moves the globe pauses the flight. Opacity and time of the flight end with the panel. thread:
/// main for every call
class Flights : public Panel {
 public:
  Flights(const ViewerContext& context, FlightCalls calls) : Panel(context, "Flight"), calls_(std::move(calls)) {}

  /// Adds the flight of a file, chooses it and opens the panel. A file that cannot be read is reported.
  void open(const std::filesystem::path& file);
  /// Looks for tours in a file of KML, beside the window's work, and adds them. They are told of if `tell`.
  void look_into(const std::filesystem::path& file, bool tell);
  void refresh_bookmarks();
  /// False once, with a message, if a film would be cancelled.
  [[nodiscard]] bool may_quit();
  /// Gives a scene the opacity and time that the globe has without the flight.
  void put_back(SceneOptions& scene) const;
  /// Moves the globe's camera on, and takes the ends of work beside the window. Call it once per frame.
  void advance(Seconds now);

  [[nodiscard]] bool changed() const override;
  [[nodiscard]] std::string job() const override;

 private:
  struct Flight {
    std::filesystem::path file{};   ///< empty: the bookmarks
    std::vector<FlightPath> paths;  ///< empty: there are too few bookmarks
    [[nodiscard]] std::string name() const { return file.empty() ? "Bookmarks" : file.filename().string(); }
  };
  struct Looked {
    std::filesystem::path path;
    bool tell = true;
    std::future<Result<FlightFile>> file;
    [[nodiscard]] bool has_come() const { return file.wait_for(std::chrono::seconds(0)) == std::future_status::ready; }
  };
  void draw_open(float foot) override;
  void toggled() override;
  void draw_choice();
  void draw_play();
  void draw_film();
  [[nodiscard]] Flight& chosen() { return flights_[static_cast<std::size_t>(chosen_)]; }
  /// A setting of the globe that the flight replaced, and the flight's own.
  template <class Value>
  struct Replaced {
    Value before, by;
  };
  int add(const std::filesystem::path& file, FlightFile read);
  void take(int flight);
  void take_tours();
  void take_film();
  void restore_scene();
  void forget_users_settings();
  void show_look(std::optional<double> alpha, std::optional<UtcTime> sun);
  void play(bool on);
  void stand();
  void go(double time_s);
  void save_flight();
  void save_film();
  [[nodiscard]] std::vector<std::string> film_arguments(const SceneOptions& scene,
                                                        const std::filesystem::path& scene_file,
                                                        const std::filesystem::path& flight_file) const;

  FlightCalls calls_;
  std::vector<Flight> flights_{{.file = {}, .paths = {}}};
  int chosen_ = 0;
  double time_s_ = 0.0;
  bool playing_ = false, loops_ = false;
  int speed_ = 2;       ///< index of the speeds
  Seconds moved_{0.0};  ///< time of the last step
  std::vector<Looked> looked_;
  int rate_ = 2;           ///< index of the numbers of frames a second
  bool one_file_ = false;  ///< the film is an MP4
  std::unique_ptr<FilmJob> film_;
  std::string shown_job_;  ///< job() in the last frame
  bool warned_ = false;    ///< may_quit() has told of the film
  std::optional<Replaced<double>> alpha_;
  std::optional<Replaced<std::optional<UtcTime>>> time_;
};

}  // namespace terrella
