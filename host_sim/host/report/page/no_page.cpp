// In the place of the pages where the program is built without node.

#include "host_sim/host/report/page/page.hpp"

namespace volcomp::host {

std::string report_page() { return {}; }
std::string live_page() { return {}; }
std::string live_script() { return {}; }
std::string live_style() { return {}; }

}  // namespace volcomp::host
