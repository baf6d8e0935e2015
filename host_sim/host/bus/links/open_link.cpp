#include <string_view>

#include "host_sim/host/bus/links/frame_link.hpp"
#include "host_sim/host/bus/links/pipe_link.hpp"
#include "host_sim/host/bus/links/slcan_link.hpp"
#include "host_sim/host/bus/links/socket_link.hpp"
#include "host_sim/host/io/user_error.hpp"

namespace volcomp::host {
namespace {

// What follows the prefix; empty when it is not there.
std::string after(std::string_view prefix, const std::string& name) {
  return name.compare(0, prefix.size(), prefix) == 0 ? name.substr(prefix.size()) : std::string();
}

}  // namespace

std::unique_ptr<FrameLink> open_frame_link(const std::string& name) {
  if (name == "pipe:") throw UserError("pipe: needs a folder, as in pipe:/tmp/node");
  if (name == "slcan:") throw UserError("slcan: needs a device, as in slcan:/dev/ttyACM0");
  if (const std::string folder = after("pipe:", name); !folder.empty())
    return std::make_unique<PipeLink>(folder);
  if (const std::string device = after("slcan:", name); !device.empty())
    return std::make_unique<SlcanLink>(device);
  return std::make_unique<SocketLink>(name);
}

}  // namespace volcomp::host
