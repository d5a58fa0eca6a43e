#pragma once

#include "tools/simulator/serve/serve_options.hpp"

namespace bodyscan::simulator {

// Serves a world: a Nikon D5000 over PTP/IP and a virtual projector that it sees. Once both can be used, one
// line on standard output tells where, "ready ptpip:127.0.0.1:PORT:PORT SOCKET". Returns on SIGTERM or
// SIGINT, which stay blocked.
Expected<void> serve(const ServeOptions& options);

}  // namespace bodyscan::simulator
