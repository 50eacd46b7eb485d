#pragma once

#include "view.hpp"

class QComboBox;
class QCheckBox;
class QDoubleSpinBox;
class QLabel;

namespace shape3d::apps::viewer {

class FourUp;

/// Three linked slices and the 3D view of a volume, with window and level.
class VolumeView : public View {
  Q_OBJECT

 public:
  explicit VolumeView(Document& document);
  ~VolumeView() override;

  [[nodiscard]] QWidget* content() override;
  [[nodiscard]] QWidget* panel() override { return panel_; }
  [[nodiscard]] QString missing() const override;
  [[nodiscard]] nlohmann::json state() const override;
  void set_state(const nlohmann::json& state) override;
  void reset() override;
  [[nodiscard]] std::vector<KeyHelp> keys() const override;
  void set_theme(const Theme& theme) override;
  void set_active(bool active) override;

  [[nodiscard]] FourUp* four_up() const { return four_up_; }

 private:
  void make_panel();
  void show_window();
  void show_facts();

  Document& document_;
  FourUp* four_up_ = nullptr;
  QWidget* panel_ = nullptr;
  QComboBox* preset_ = nullptr;
  QDoubleSpinBox *level_ = nullptr, *width_ = nullptr;
  QCheckBox* planes_ = nullptr;
  QLabel* facts_ = nullptr;
};

/// What a view of volumes says when there is none.
[[nodiscard]] QString missing_volume(const Document& document);

}  // namespace shape3d::apps::viewer
