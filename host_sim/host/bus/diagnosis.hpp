#pragma once
// Reads the state of a compensation node over SDO and describes it in plain sentences.

#include <array>
#include <cstdint>
#include <string>

#include <nlohmann/json.hpp>

#include "hal/reset_cause.hpp"
#include "host_sim/host/bus/node_client.hpp"

namespace volcomp::host {

// What `volcomp diagnose --json` writes: plain values under their names in objects.def, states in
// words; offsets in µm, or µrad of a rotary axis; `network_state` null without a heartbeat within a
// second, `axes` those with a drive. Throws as NodeClient::read.
[[nodiscard]] nlohmann::json diagnose(NodeClient& client);
// The same for people.
[[nodiscard]] std::string describe(const nlohmann::json& diagnosis);

// One field of 1003h: the error and its source.
[[nodiscard]] std::string describe_error(std::uint32_t field);
// Describes the conditions of an axis; "corrected" when there are none.
[[nodiscard]] std::string describe_status(std::uint16_t status);
// Describes the state of a drive from 6041h (CiA 402-2).
[[nodiscard]] std::string describe_drive(std::uint16_t status_word);
// Why the processor started.
[[nodiscard]] const char* words(hal::ResetCause cause);

// --- pieces of diagnoses

// Reads the objects into the members of `facts` that have their names.
template <class... T>
void read_facts(NodeClient& client, nlohmann::json& facts,
                const canopen::object_lines::Handle<T>&... object) {
  ((facts[object.member] = client.read(object)), ...);
}

// That of an enumeration from 0.
template <std::size_t count>
[[nodiscard]] const char* word_of(const std::array<const char*, count>& words, std::size_t value) {
  return value < count ? words[value] : "unknown";
}

}  // namespace volcomp::host
