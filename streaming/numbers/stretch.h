#pragma once

namespace terrella {

/// The range of values that is shown, from black to white or from the first to the last colour; low < high.
struct Stretch {
  double low = 0.0;
  double high = 255.0;
};

}  // namespace terrella
