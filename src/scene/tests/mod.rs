mod images;
mod layout;
mod lens;
mod setting;
mod uri;
mod views;
