mod environment;
mod images;
mod layout;
mod lens;
mod motion;
mod setting;
mod uri;
mod views;
