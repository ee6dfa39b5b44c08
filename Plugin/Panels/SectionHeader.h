// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class tautline::SectionHeader
 * @brief The button that opens and closes a section of a panel, see pqTautlineSection.
 */

#ifndef tautline_SectionHeader_h
#define tautline_SectionHeader_h

#include <QPointer>
#include <QTimer>
#include <QToolButton>

#include <vector>

class pqPropertyWidget;
class pqSearchBox;
class vtkSMProxy;

namespace tautline
{

class SectionHeader : public QToolButton
{
  Q_OBJECT

public:
  /**
   * @param text the name of the section
   * @param proxy its kind remembers whether the section is open
   */
  SectionHeader(const QString& text, vtkSMProxy* proxy, QWidget* panel);

  /// The name of the button of a section: "Section_Boundary_and_geometry".
  static QString nameOf(const QString& text);

  /// Adds a property to the section.
  void add(pqPropertyWidget* field);

  /// Whether the user searches the panel: all that is found is shown.
  bool isSearched() const;

  /// Shows or hides the button when the panel is up to date.
  void updateLater();

private Q_SLOTS:
  void open(bool checked);
  void showContent();

private:
  bool eventFilter(QObject* panel, QEvent* event) override;
  /// Whether the section has a property that is shown while it is open.
  bool hasContent() const;

  std::vector<QPointer<pqPropertyWidget>> Fields;
  mutable QPointer<pqSearchBox> Search;
  QString Key; ///< of the sections that were opened
  QTimer Later;
};

} // namespace tautline

#endif
