// SPDX-License-Identifier: BSD-3-Clause
#include "SectionHeader.h"

#include "pqTautlineSection.h"

#include "pqPropertiesPanel.h"
#include "pqPropertyWidget.h"
#include "pqSearchBox.h"

#include "vtkSMProxy.h"

#include <QEvent>
#include <QSet>

#include <algorithm>

namespace tautline
{
namespace
{
/// The sections that the user has opened and not closed.
QSet<QString>& opened()
{
  static QSet<QString> keys;
  return keys;
}
}

//------------------------------------------------------------------------------
SectionHeader::SectionHeader(const QString& text, vtkSMProxy* proxy, QWidget* panel)
  : QToolButton(panel)
  , Key(QString(proxy->GetXMLName()) + "/" + text)
{
  this->setObjectName(SectionHeader::nameOf(text));
  this->setText(text);
  this->setToolTip("Show or hide the settings of this section.");
  this->setCheckable(true);
  this->setAutoRaise(true);
  this->setToolButtonStyle(Qt::ToolButtonTextBesideIcon);
  this->setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Fixed);
  QFont bold = this->font();
  bold.setBold(true);
  this->setFont(bold);
  this->setChecked(opened().contains(this->Key));
  this->setArrowType(this->isChecked() ? Qt::DownArrow : Qt::RightArrow);
  this->hide();
  this->Later.setSingleShot(true);
  this->Later.setInterval(0);
  QObject::connect(&this->Later, &QTimer::timeout, this, &SectionHeader::showContent);
  QObject::connect(this, &QToolButton::toggled, this, &SectionHeader::open);
  panel->installEventFilter(this);
}

//------------------------------------------------------------------------------
QString SectionHeader::nameOf(const QString& text)
{
  return "Section_" + QString(text).replace(' ', '_');
}

//------------------------------------------------------------------------------
void SectionHeader::add(pqPropertyWidget* field)
{
  this->Fields.emplace_back(field);
  for (const auto& decorator : field->decorators())
  {
    QObject::connect(decorator.data(), &pqPropertyWidgetDecorator::visibilityChanged, this,
      &SectionHeader::updateLater);
  }
}

//------------------------------------------------------------------------------
bool SectionHeader::isSearched() const
{
  for (QWidget* parent = this->parentWidget(); parent && !this->Search;
       parent = parent->parentWidget())
  {
    if (qobject_cast<pqPropertiesPanel*>(parent))
    {
      this->Search = parent->findChild<pqSearchBox*>("SearchBox");
    }
  }
  return this->Search && !this->Search->text().isEmpty();
}

//------------------------------------------------------------------------------
void SectionHeader::updateLater()
{
  if (!this->Later.isActive())
  {
    this->Later.start();
  }
}

//------------------------------------------------------------------------------
void SectionHeader::open(bool checked)
{
  this->setArrowType(checked ? Qt::DownArrow : Qt::RightArrow);
  if (checked)
  {
    opened().insert(this->Key);
  }
  else
  {
    opened().remove(this->Key);
  }
}

//------------------------------------------------------------------------------
bool SectionHeader::hasContent() const
{
  const bool searched = this->isSearched();
  return std::any_of(this->Fields.begin(), this->Fields.end(),
    [searched](const QPointer<pqPropertyWidget>& field)
    {
      if (!field || searched)
      {
        return field && !field->isHidden();
      }
      const auto& decorators = field->decorators();
      return std::all_of(decorators.begin(), decorators.end(),
        [](const QPointer<pqPropertyWidgetDecorator>& decorator)
        {
          return !decorator || qobject_cast<pqTautlineSection*>(decorator.data()) ||
            decorator->canShowWidget(true);
        });
    });
}

//------------------------------------------------------------------------------
void SectionHeader::showContent()
{
  this->setVisible(this->hasContent());
}

//------------------------------------------------------------------------------
bool SectionHeader::eventFilter(QObject* panel, QEvent* event)
{
  if (event->type() == QEvent::LayoutRequest)
  {
    this->updateLater(); // a field was shown or hidden
  }
  return QToolButton::eventFilter(panel, event);
}

} // namespace tautline
