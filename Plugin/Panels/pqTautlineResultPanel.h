// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class pqTautlineResultPanel
 * @brief Shows the property Summary of a filter: text to read, to follow and to copy.
 *
 * The text is wrapped and cannot be edited. "element 433" or "cell 433" in it is a link: it selects
 * the element on the first output of the filter and moves the camera of the active view to it. In
 * paragraphs that begin with "In block 2: " the numbers are those within the block. One button
 * copies the whole text, another one saves the result as an HTML file on the computer of the
 * client.
 *
 * In the XML of a proxy: `panel_widget="tautline_result"` on a string property.
 */

#ifndef pqTautlineResultPanel_h
#define pqTautlineResultPanel_h

#include "pqPropertyWidget.h"

class QLabel;
class QTextBrowser;
class QToolButton;
class QUrl;
class pqPipelineSource;

class pqTautlineResultPanel : public pqPropertyWidget
{
  Q_OBJECT
  Q_PROPERTY(QString text READ text WRITE setText NOTIFY textChanged)
  using Superclass = pqPropertyWidget;

public:
  pqTautlineResultPanel(vtkSMProxy* proxy, vtkSMProperty* property, QWidget* parent = nullptr);
  ~pqTautlineResultPanel() override;

  ///@{
  /// The text without links.
  const QString& text() const { return this->Text; }
  void setText(const QString& text);
  ///@}

  /// The text as HTML: escaped, with a link element:CELL:BLOCK:PROCESS:PARTITION for each element.
  static QString linked(const QString& text);

Q_SIGNALS:
  void textChanged();

public Q_SLOTS:
  /// Selects the element of a link and moves the camera to it.
  void follow(const QUrl& link);

private Q_SLOTS:
  void copy();
  void saveReport();
  void sideBySide();
  void freeAndRetry();
  void fitWidth();

private:
  void changeEvent(QEvent* event) override;
  void showEvent(QShowEvent* event) override;
  pqPipelineSource* source() const;
  void showNote(const QString& note);
  /// As high as the text, up to a limit.
  void fitHeight();

  QString Text;
  QTextBrowser* Browser;
  QToolButton* Copy;
  QToolButton* Save;
  QToolButton* Compare; ///< for filters that change a mesh
  QToolButton* Retry;   ///< for filters that left elements invalid
  QLabel* Note;         ///< what was selected or saved, or what is wrong
};

#endif
