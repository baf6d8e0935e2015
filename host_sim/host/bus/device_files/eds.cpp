#include "host_sim/host/bus/device_files/eds.hpp"

#include <fmt/format.h>

#include "firmware/node/object_handles.hpp"
#include "host_sim/host/bus/device_files/eds_objects.hpp"

namespace volcomp::host {
namespace {

namespace object = node::object;
using Objects = std::vector<EdsObject>;

template <class T>
const std::string& default_of(const Objects& objects, const canopen::object_lines::Handle<T>& of) {
  for (const EdsObject& object : objects) {
    if (object.index != of.index) continue;
    for (const EdsValue& value : object.values) {
      if (value.sub == of.sub) return value.value.value();
    }
  }
  throw std::logic_error(fmt::format("the node has no {}", of.name));
}

// The dates are those of this layout of the file: a file that is made again must not differ.
void write_file_info(std::string& out) {
  out +=
      "[FileInfo]\n"
      "FileName=volcomp.eds\n"
      "FileVersion=1\n"
      "FileRevision=0\n"
      "EDSVersion=4.0\n"
      "Description=Volumetric error compensation node\n"
      "CreationTime=12:00PM\n"
      "CreationDate=11-21-2026\n"
      "CreatedBy=volcomp device-files\n"
      "ModificationTime=12:00PM\n"
      "ModificationDate=11-21-2026\n"
      "ModifiedBy=volcomp device-files\n\n"
      "[Comments]\n"
      "Lines=2\n"
      "Line1=Made from the object dictionary of the code by: volcomp device-files --eds FILE\n"
      "Line2=Values of drives and axes are those of a node that was never configured.\n\n";
}

// CiA 306-1, table 3. The bit rates are those that every board can set.
void write_device_info(std::string& out, const Objects& objects) {
  out += fmt::format(
      "[DeviceInfo]\n"
      "VendorName=volcomp\n"
      "VendorNumber={}\n"
      "ProductName={}\n"
      "ProductNumber={}\n"
      "RevisionNumber={}\n"
      "OrderCode=\n",
      default_of(objects, object::vendor_id), default_of(objects, object::device_name),
      default_of(objects, object::product_code), default_of(objects, object::revision));
  for (const int kbit_s : {10, 20, 50, 125, 250, 500, 800, 1000}) {
    const bool usual = kbit_s >= 125 && kbit_s != 800;
    out += fmt::format("BaudRate_{}={}\n", kbit_s, usual ? 1 : 0);
  }
  out += fmt::format(
      "SimpleBootUpMaster=0\n"
      "SimpleBootUpSlave=1\n"
      "Granularity=8\n"
      "DynamicChannelsSupported=0\n"
      "CompactPDO=0\n"
      "GroupMessaging=0\n"
      "NrOfRXPDO={}\n"
      "NrOfTXPDO={}\n"
      "LSS_Supported=0\n\n",
      node::kReceivePdos, node::kTransmitPdos);
}

// Which types may stand in an RPDO for bytes that are skipped: all but BOOLEAN, mapping is in
// bytes.
void write_dummy_usage(std::string& out) {
  out += "[DummyUsage]\n";
  for (int type = 1; type <= 7; ++type)
    out += fmt::format("Dummy{:04X}={}\n", type, type == 1 ? 0 : 1);
  out += '\n';
}

// CiA 306-1 lets a default be left out. Tools differ in how they read that of a real; lely's dcfgen
// takes only whole numbers and refuses the whole file for 0.5.
bool has_written_default(const EdsValue& v) {
  const bool real = v.type == canopen::DataType::real32 || v.type == canopen::DataType::real64;
  return v.value && !real;
}

void write_value(std::string& out, const EdsValue& v) {
  const bool domain = v.type == canopen::DataType::domain;
  out += fmt::format("DataType=0x{:04X}\nAccessType={}\n", static_cast<unsigned>(v.type), v.access);
  if (v.low) out += fmt::format("LowLimit={}\n", *v.low);
  if (v.high) out += fmt::format("HighLimit={}\n", *v.high);
  if (has_written_default(v)) out += fmt::format("DefaultValue={}\n", *v.value);
  if (!domain) out += fmt::format("PDOMapping={}\n", v.mappable ? 1 : 0);
}

void write_head(std::string& out, const std::string& section, const std::string& name,
                ObjectCode code) {
  out += fmt::format("[{}]\nParameterName={}\nObjectType=0x{:X}\n", section, name,
                     static_cast<unsigned>(code));
}

void write_object(std::string& out, const EdsObject& object) {
  write_head(out, fmt::format("{:04X}", object.index), object.name, object.code);
  if (object.code == ObjectCode::var) {
    write_value(out, object.values.front());
    out += '\n';
    return;
  }
  out += fmt::format("SubNumber={}\n\n", object.values.size());
  for (const EdsValue& v : object.values) {
    const bool domain = v.type == canopen::DataType::domain;
    write_head(out, fmt::format("{:04X}sub{:X}", object.index, v.sub), v.name,
               domain ? ObjectCode::domain : ObjectCode::var);
    write_value(out, v);
    out += '\n';
  }
}

// CiA 306-1, section 4.6.2.
enum class Group { mandatory, optional, manufacturer };

Group group_of(const EdsObject& object) {
  const std::uint16_t index = object.index;
  if (index == object::device_type.index || index == object::error_register.index ||
      index == object::vendor_id.index)
    return Group::mandatory;
  return index >= 0x2000 && index < 0x6000 ? Group::manufacturer : Group::optional;
}

void write_group(std::string& out, const Objects& objects, Group group, const char* name) {
  std::string list;
  std::string sections;
  int count = 0;
  for (const EdsObject& object : objects) {
    if (group_of(object) != group) continue;
    list += fmt::format("{}=0x{:04X}\n", ++count, object.index);
    write_object(sections, object);
  }
  out += fmt::format("[{}]\nSupportedObjects={}\n{}\n{}", name, count, list, sections);
}

}  // namespace

std::string make_eds() {
  const Objects objects = node_eds_objects();
  std::string out;
  write_file_info(out);
  write_device_info(out, objects);
  write_dummy_usage(out);
  write_group(out, objects, Group::mandatory, "MandatoryObjects");
  write_group(out, objects, Group::optional, "OptionalObjects");
  write_group(out, objects, Group::manufacturer, "ManufacturerObjects");
  out.pop_back();
  return out;
}

}  // namespace volcomp::host
