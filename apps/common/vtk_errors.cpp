#include "vtk_errors.hpp"

#include <vtkCallbackCommand.h>
#include <vtkCommand.h>
#include <vtkObject.h>

namespace shape3d::apps {

VtkErrors::VtkErrors() : command_(vtkSmartPointer<vtkCallbackCommand>::New()) {
  command_->SetCallback(&VtkErrors::on_event);
  command_->SetClientData(this);
}

VtkErrors::~VtkErrors() { command_->SetClientData(nullptr); }

void VtkErrors::observe(vtkObject* object) {
  object->AddObserver(vtkCommand::ErrorEvent, command_);
  object->AddObserver(vtkCommand::WarningEvent, command_);
}

vtkCommand* VtkErrors::command() const { return command_; }

void VtkErrors::on_event(vtkObject*, unsigned long event, void* self, void* text) {
  auto* errors = static_cast<VtkErrors*>(self);
  if (errors == nullptr || event != vtkCommand::ErrorEvent || errors->any()) return;
  std::string message = text != nullptr ? static_cast<const char*>(text) : "unknown error";
  // "ERROR: In FILE, line N\nvtkClass (0x…): message\n\n"
  if (const std::size_t start = message.find("): "); start != std::string::npos) message.erase(0, start + 3);
  while (!message.empty() && (message.back() == '\n' || message.back() == ' ')) message.pop_back();
  for (char& c : message) {
    if (c == '\n') c = ' ';
  }
  errors->first_ = message.empty() ? "unknown error" : message;
}

}  // namespace shape3d::apps
