// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class pqTautlineSelection
 * @brief Copies the active selection into an input of a filter: what was copied and two buttons in
 * one line.
 *
 * ParaView's widget for it, which has a table of all indices below, does the work and is rearranged
 * here; the table is the tool tip.
 *
 * In the XML of a proxy: `panel_widget="tautline_selection"` on an input property.
 */

#ifndef pqTautlineSelection_h
#define pqTautlineSelection_h

#include "pqPropertyWidget.h"

class QLabel;
class QToolButton;
class pqSelectionInputWidget;

class pqTautlineSelection : public pqPropertyWidget
{
  Q_OBJECT
  using Superclass = pqPropertyWidget;

public:
  pqTautlineSelection(vtkSMProxy* proxy, vtkSMProperty* property, QWidget* parent = nullptr);
  ~pqTautlineSelection() override;

  void apply() override;

  /// What a selection has, in words: "12 cells", "none".
  static QString describe(vtkSMProxy* selection);

private Q_SLOTS:
  void clear();
  void refresh();

private:
  pqSelectionInputWidget* Input;
  QLabel* Text;
  QToolButton* Clear;
};

#endif
